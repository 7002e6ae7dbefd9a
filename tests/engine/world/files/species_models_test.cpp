// The species of the worlds that come with the engine, as models: the same bits on every
// instruction set, and those of the double-precision oracle.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/models/kit/simd_targets.hpp"
#include "engine/models/tree/species.hpp"
#include "engine/world/files/world_file.hpp"
#include "tests/engine/models/oracle/expect_tree.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using models::test::Mesh;
using models::test::synthesise;

struct Shipped {
  const char* world;
  std::size_t species;
};
void PrintTo(const Shipped& shipped, std::ostream* out) {
  *out << shipped.world;
}

class SpeciesModels : public ::testing::TestWithParam<Shipped> {
 protected:
  void SetUp() override {
    registry_ = models::make_standard_registry();
    const auto world = load_world(
        testing::game_file(std::string("worlds/") + GetParam().world + ".toml"), registry_);
    ASSERT_TRUE(world) << world.error().message;
    for (const models::Species& s : world->species)
      names_.push_back(s.name);
    ASSERT_EQ(names_.size(), GetParam().species);
  }
  void TearDown() override { models::unpin_simd_target(); }

  // Some trees of every species: the default tree in the middle of each season, then random ones.
  template <class Visit>
  void for_trees(const Visit& visit) {
    core::RandomStream random(31, 0, 0, 0, core::Purpose::kParameters);
    for (const std::string& name : names_) {
      const models::ModelType& type =
          registry_[static_cast<models::ModelIndex>(registry_.find(name))];
      for (int i = 0; i < 8; ++i) {
        models::Parameters p = models::test::random_parameters(type, random);
        if (i < 4) {
          p = models::default_parameters(type);
          p.set_integer(models::kSpeciesSeed, 100 + i);
          p.set_real(models::kSpeciesSeason, i);
        }
        SCOPED_TRACE(name + " " + std::to_string(i));
        for (int level = 0; level < type.level_count(); ++level)
          ASSERT_NO_FATAL_FAILURE(visit(type, p, level));
      }
    }
  }

 private:
  models::Registry registry_;
  std::vector<std::string> names_;
};

TEST_P(SpeciesModels, HaveTheSameBytesOnEveryInstructionSetAtEveryLevel) {
  for_trees([](const models::ModelType& type, const models::Parameters& p, int level) {
    models::pin_simd_target(models::simd_targets().front());
    const Mesh best = synthesise(type, p, level);
    for (const std::string_view target : models::simd_targets()) {
      models::pin_simd_target(target);
      const Mesh mesh = synthesise(type, p, level);
      ASSERT_EQ(mesh.vertex_bytes, best.vertex_bytes) << target << " level " << level;
      ASSERT_EQ(mesh.indices, best.indices) << target << " level " << level;
      ASSERT_EQ(mesh.box.min, best.box.min) << target << " level " << level;
      ASSERT_EQ(mesh.box.max, best.box.max) << target << " level " << level;
    }
  });
}

TEST_P(SpeciesModels, MeetTheOracleOnEveryInstructionSetAtEveryLevel) {
  for_trees([](const models::ModelType& type, const models::Parameters& p, int level) {
    const models::TreePlan plan = models::plan_of_species(type, p);
    models::test::TreeOracle oracle(plan, true);
    const auto expected = oracle.mesh(level);
    for (const std::string_view target : models::simd_targets()) {
      SCOPED_TRACE(target);
      models::pin_simd_target(target);
      expect_as_oracle(oracle, expected, plan.bounds, synthesise(type, p, level), level);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Worlds, SpeciesModels,
                         ::testing::Values(Shipped{"five_species", 6}, Shipped{"silver_combe", 4},
                                           Shipped{"lakes", 3}, Shipped{"ember_pass", 3},
                                           Shipped{"thorn_country", 3}, Shipped{"frost_isle", 1}),
                         [](const auto& test) { return std::string(test.param.world); });

}  // namespace
}  // namespace psygen::world
