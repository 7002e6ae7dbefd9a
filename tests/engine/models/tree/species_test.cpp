#include "engine/models/tree/species.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>

#include "engine/models/kit/packing.hpp"
#include "engine/models/kit/simd_targets.hpp"
#include "engine/models/tree/skeleton.hpp"
#include "engine/models/tree/tree.hpp"
#include "tests/engine/models/oracle/expect_tree.hpp"

namespace psygen::models {
namespace {

using ::testing::HasSubstr;

Species small_species() {
  Species s;
  s.name = "ash";
  s.doc = "for tests";
  s.axiom = "T";
  s.kinds.resize(3);
  s.kinds[0].symbol = "T";
  s.kinds[1].symbol = "L";
  s.kinds[1].leader = true;
  s.kinds[2].symbol = "S";
  s.rules = {{"T", "LS*", 1}, {"L", "LS*", 1}, {"S", "S2", 0.5}, {"S", "LS3", 0.5}};
  return s;
}

// A valid grammar of any kind, or nothing.
std::optional<Species> random_species(core::RandomStream& random) {
  Species s;
  s.name = "any";
  s.doc = "any";
  s.iterations = random.next_integer(1, 8);
  s.branches = random.next_integer(1, 5);
  s.spread = random.next_integer(0, 3);
  s.crown_limit = random.next_integer(0, 1) == 0 ? 0 : random.next_real(0.3, 2);
  s.trunk_curvature = random.next_real(0, 2);
  const auto kinds = static_cast<std::size_t>(random.next_integer(1, 5));
  static constexpr const char* kLeaves[] = {"none", "tips", "all"};
  static constexpr const char* kForms[] = {"leaflets", "needles", "fronds", "clump", "none"};
  for (std::size_t i = 0; i < kinds; ++i) {
    SpeciesKind k;
    k.symbol = std::string(1, static_cast<char>('A' + i));
    k.leader = random.next_integer(0, 2) == 0;
    k.leaves = kLeaves[random.next_integer(0, 2)];
    k.angle_deg = random.next_real(0, 120);
    k.angle_low_deg = random.next_real(0, 120);
    k.along_low = random.next_real(0, 1);
    k.length = random.next_real(0.3, 0.95);
    k.length_low = random.next_real(0.3, 1.2);
    k.radius = random.next_real(0.2, 1);
    k.tropism = random.next_real(-0.6, 0.6);
    s.kinds.push_back(k);
  }
  s.axiom = "A";
  for (std::size_t i = 0; i < kinds; ++i) {
    const std::int64_t rules = i == 0 ? 1 : random.next_integer(0, 2);
    for (std::int64_t r = 0; r < rules; ++r) {
      std::string to;
      for (std::int64_t n = random.next_integer(1, 3); n > 0; --n) {
        const auto kind =
            static_cast<std::size_t>(random.next_integer(0, static_cast<int>(kinds) - 1));
        const std::int64_t count = random.next_integer(1, 4);
        to += s.kinds[kind].symbol + std::to_string(count);
      }
      if (random.next_integer(0, 1) == 0) to += s.kinds[kinds - 1].symbol + "*";
      s.rules.push_back({s.kinds[i].symbol, to, 1.0 / static_cast<double>(rules)});
    }
  }
  s.foliage.form = kForms[random.next_integer(0, 4)];
  s.foliage.density = random.next_real(0.2, 8);
  s.foliage.density_summer = random.next_real(0, 1);
  if (find_fault(s)) return std::nullopt;
  return s;
}

TEST(Species, HasExactSizesForRandomGrammarsAndSeeds) {
  core::RandomStream random(41, 0, 0, 0, core::Purpose::kParameters);
  int grammars = 0;
  for (int i = 0; i < 400; ++i) {
    const auto species = random_species(random);
    if (!species) continue;
    ++grammars;
    const auto type = make_species_type(*species).value();
    for (int k = 0; k < 4; ++k) {
      Parameters p = default_parameters(*type);
      p.set_integer(kSpeciesSeed, static_cast<std::int64_t>(random.next_u64()));
      for (int level = 0; level < type->level_count(); ++level) {
        const test::Mesh mesh = test::synthesise(*type, p, level);  // checks canaries
        ASSERT_LE(mesh.size.vertex_count, 65536U);
        ASSERT_LE(std::log2(mesh.size.triangle_count()), type->log2_cost(p));
        for (const std::uint16_t index : mesh.indices)
          ASSERT_LT(index, mesh.size.vertex_count);
        if (level > 0) {
          ASSERT_LE(mesh.size.triangle_count(), type->mesh_size(p, level - 1).triangle_count());
        }
      }
    }
  }
  EXPECT_GT(grammars, 100);
}

TEST(Species, MeetsTheOracleOnEveryInstructionSet) {
  core::RandomStream random(42, 0, 0, 0, core::Purpose::kParameters);
  std::vector<Species> all{small_species()};
  while (all.size() < 24)
    if (auto species = random_species(random)) all.push_back(*species);
  for (const std::string_view target : simd_targets()) {
    pin_simd_target(target);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto type = make_species_type(all[i]).value();
      Parameters p = default_parameters(*type);
      p.set_integer(kSpeciesSeed, 77);
      p.set_real(kSpeciesSeason, std::fmod(0.7 * static_cast<double>(i), 4));
      const TreePlan plan = plan_of_species(*type, p);
      test::TreeOracle oracle(plan, true);
      for (int level = 0; level < type->level_count(); ++level) {
        SCOPED_TRACE(target);
        const test::Mesh mesh = test::synthesise(*type, p, level);
        ASSERT_NO_FATAL_FAILURE(
            expect_as_oracle(oracle, oracle.mesh(level), plan.bounds, mesh, level));
      }
    }
  }
  unpin_simd_target();
}

TEST(Species, ChangesItsIdentityWithEveryNumber) {
  const auto identity = [](const Species& s) { return make_species_type(s).value()->identity(); };
  const std::uint64_t before = identity(small_species());
  EXPECT_EQ(identity(small_species()), before);
  Species s = small_species();
  s.kinds[2].angle_deg += 1e-9;
  EXPECT_NE(identity(s), before);
  s = small_species();
  s.rules[2].to = "S3";
  EXPECT_NE(identity(s), before);
  s = small_species();
  s.colours.season[2][1] += 0.001;
  EXPECT_NE(identity(s), before);
  const Parameters p;
  EXPECT_NE(parameters_hash(*make_species_type(s).value(), p),
            parameters_hash(*make_species_type(small_species()).value(), p));
}

TEST(Species, ShedsLeavesOfTheSameSizeWithTheSeason) {
  Species s = small_species();
  s.foliage.density = 40;
  s.foliage.density_autumn = 0.5;
  s.foliage.density_winter = 0;
  const auto type = make_species_type(s).value();
  const auto at = [&](double season) {
    Parameters p = default_parameters(*type);
    p.set_real(kSpeciesSeason, season);
    return p;
  };
  const TreePlan summer = plan_of_species(*type, at(1)), autumn = plan_of_species(*type, at(2));
  EXPECT_FLOAT_EQ(autumn.foliage.density, 0.5F * summer.foliage.density);
  EXPECT_FLOAT_EQ(autumn.foliage.fill / std::sqrt(autumn.foliage.density),
                  summer.foliage.fill / std::sqrt(summer.foliage.density));
  EXPECT_EQ(plan_of_species(*type, at(3)).foliage.near, nullptr);
  for (int level = 0; level < 2; ++level) {
    EXPECT_LT(type->mesh_size(at(2), level).vertex_count,
              type->mesh_size(at(1), level).vertex_count);
    EXPECT_LT(type->mesh_size(at(3), level).vertex_count,
              type->mesh_size(at(2.5), level).vertex_count);
    test::synthesise(*type, at(3), level);
  }
}

TEST(Species, ChangesColourButNotShapeWithTheSeason) {
  const auto type = make_species_type(small_species()).value();
  Parameters summer = default_parameters(*type), autumn = summer;
  autumn.set_real(kSpeciesSeason, 2);
  const auto a = test::synthesise(*type, summer, 0).vertices<core::ModelVertex>();
  const auto b = test::synthesise(*type, autumn, 0).vertices<core::ModelVertex>();
  ASSERT_EQ(a.size(), b.size());
  int redder = 0, leaves = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_TRUE(std::equal(a[i].position, a[i].position + 3, b[i].position));
    if (a[i].material == 0) continue;
    ++leaves;
    redder += b[i].colour[0] > a[i].colour[0] ? 1 : 0;
  }
  EXPECT_GT(redder, leaves * 9 / 10);
}

TEST(Species, RejectsHostileGrammarsBeforeTheyGrow) {
  const auto message = [](const auto& change) {
    Species s = small_species();
    change(s);
    const auto type = make_species_type(s);
    return type ? std::string("accepted") : type.error().message;
  };
  EXPECT_THAT(message([](Species& s) { s.iterations = 1'000'000'000; }),
              HasSubstr("predicted cost: 2^"));
  EXPECT_THAT(message([](Species& s) { s.iterations = INT64_MIN; }), HasSubstr("iterations"));
  EXPECT_THAT(message([](Species& s) { s.branches = INT64_MAX; }), HasSubstr("predicted cost"));
  EXPECT_THAT(message([](Species& s) { s.rules[0].to = "S65"; }), HasSubstr("rule[0].to"));
  EXPECT_THAT(message([](Species& s) { s.rules[2].to = "S64"; }), HasSubstr("predicted cost"));
  EXPECT_THAT(message([](Species& s) { s.rules[2].to = "S64"; }), HasSubstr("grows too fast"));
  EXPECT_THAT(message([](Species& s) { s.rules[2].to = "Z"; }), HasSubstr("unknown"));
  EXPECT_THAT(message([](Species& s) { s.rules[2].to = "S0"; }), HasSubstr("not allowed"));
  EXPECT_THAT(message([](Species& s) { s.rules[2].to = " "; }), HasSubstr("at least one"));
  EXPECT_THAT(message([](Species& s) { s.rules[2].probability = 0.4; }), HasSubstr("sum up"));
  EXPECT_THAT(message([](Species& s) { s.rules[2].probability = std::nan(""); }),
              HasSubstr("rule[2].probability"));
  EXPECT_THAT(message([](Species& s) { s.size_m = std::nan(""); }), HasSubstr("size_m"));
  EXPECT_THAT(message([](Species& s) { s.kinds[1].symbol = "T"; }), HasSubstr("symbol"));
  EXPECT_THAT(message([](Species& s) { s.rules.erase(s.rules.begin()); }), HasSubstr("axiom"));
  EXPECT_THAT(message([](Species& s) { s.foliage.density = -1; }), HasSubstr("foliage.density"));
  EXPECT_THAT(message([](Species& s) { s.foliage.density_winter = 1.1; }),
              HasSubstr("foliage.density_winter"));
  for (const double limit : {1e-60, 1e-39, 0.04, -0.1, 4.1, std::nan("")})
    EXPECT_THAT(message([&](Species& s) { s.crown_limit = limit; }), HasSubstr("crown_limit"));
  for (const double limit : {0.0, 0.05, 4.0})
    EXPECT_EQ(message([&](Species& s) { s.crown_limit = limit; }), "accepted");
  EXPECT_EQ(message([](Species&) {}), "accepted");
}

TEST(Tree, PredictsTheSizeOfAMillionTrees) {
  const auto type = make_tree_type();
  core::RandomStream random(43, 0, 0, 0, core::Purpose::kParameters);
  std::vector<std::byte> vertices(65536 * sizeof(core::ModelVertex));
  std::vector<std::uint16_t> indices(3 * 131072);
  for (int i = 0; i < 1'000'000; ++i) {
    const Parameters p = test::random_parameters(*type, random);
    const int level = i % 6;
    const MeshSize size = type->mesh_size(p, level);
    const std::size_t bytes = size.vertex_count * sizeof(core::ModelVertex);
    // Bytes beyond the end, with values that no mesh has at its end: neither an index nor a
    // material.
    vertices[bytes] = std::byte{0xC5};
    indices[size.index_count] = 0xC5C5;
    ASSERT_GT(size.index_count, 0U);
    std::byte& last_material =
        vertices[bytes - sizeof(core::ModelVertex) + offsetof(core::ModelVertex, material)];
    last_material = std::byte{0xC5};
    indices[size.index_count - 1] = 0xC5C5;
    type->synthesise(
        p, level, {std::span(vertices).first(bytes), std::span(indices).first(size.index_count)});
    ASSERT_EQ(vertices[bytes], std::byte{0xC5});
    ASSERT_EQ(indices[size.index_count], 0xC5C5);
    ASSERT_NE(last_material, std::byte{0xC5});
    ASSERT_NE(indices[size.index_count - 1], 0xC5C5);
    ASSERT_LT(indices[size.index_count - 1], size.vertex_count);
  }
}

}  // namespace
}  // namespace psygen::models
