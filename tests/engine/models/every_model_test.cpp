// Properties of every registered model type.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>
#include <utility>

#include "engine/models/kit/packing.hpp"
#include "engine/models/registry.hpp"
#include "engine/models/rock/rock.hpp"
#include "engine/models/terrain/grid.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "tests/engine/models/mesh_helpers.hpp"

namespace psygen::models {
namespace {

using test::Mesh;
using test::random_parameters;
using test::synthesise;

bool holds(const core::Bounds& outer, const core::Bounds& inner) {
  const glm::vec3 slack = (outer.max - outer.min) * 1e-5F;
  return glm::all(glm::greaterThanEqual(inner.min, outer.min - slack)) &&
         glm::all(glm::lessThanEqual(inner.max, outer.max + slack)) &&
         glm::all(glm::lessThanEqual(inner.min, inner.max));
}

// Visits random legal parameters of all standard types at every level.
template <class Visit>
void for_random_models(int per_type, const Visit& visit) {
  const Registry registry = make_standard_registry();
  for (ModelIndex m = 0; m < registry.size(); ++m) {
    core::RandomStream random(m, 0, 0, 0, core::Purpose::kParameters);
    for (int trial = 0; trial < per_type; ++trial) {
      const Parameters p = random_parameters(registry[m], random);
      if (!validate(registry[m], p)) continue;
      for (int level = 0; level < registry[m].level_count(); ++level)
        visit(registry[m], p, level);
    }
  }
}

TEST(EveryModel, StaysWithinItsBoundsAndItsPromisedSize) {
  for_random_models(12, [](const ModelType& type, const Parameters& p, int level) {
    const Mesh mesh = synthesise(type, p, level);
    ASSERT_LE(mesh.size.vertex_count, 65536u);
    ASSERT_EQ(mesh.size.index_count % 3, 0u);
    ASSERT_TRUE(holds(type.bounds(p), mesh.box)) << type.name() << " level " << level;
    for (const std::uint16_t index : mesh.indices)
      ASSERT_LT(index, mesh.size.vertex_count);
    if (mesh.size.layout != core::VertexLayout::kModel) return;
    const core::Bounds box = type.bounds(p);
    const glm::vec3 step = box.half_extent() / 32767.0F + glm::length(box.half_extent()) * 1e-6F;
    for (const core::ModelVertex& v : mesh.vertices<core::ModelVertex>()) {
      const glm::vec3 place = unpack_position(v, box);
      ASSERT_TRUE(glm::all(glm::greaterThanEqual(place, mesh.box.min - step)) &&
                  glm::all(glm::lessThanEqual(place, mesh.box.max + step)))
          << type.name() << " level " << level;
    }
  });
}

// Counts the vertices and triangles of a rock and of a terrain independently.
std::pair<std::uint32_t, std::uint32_t> count_again(const ModelType& type, const Parameters& p,
                                                    int level) {
  if (type.name() == "rock") {
    std::uint32_t triangles = 4;
    for (std::int64_t n = p.integer(kRockSubdivisions) - level; n > 0; --n)
      triangles *= 4;
    return {p.integer(kRockFamily) == kRockFaceted ? 3 * triangles : triangles / 2 + 2, triangles};
  }
  const auto cells = static_cast<std::uint32_t>(p.integer(kTerrainSize) - 1);
  const auto stride = static_cast<std::uint32_t>(
      terrain_strides(static_cast<int>(p.integer(kTerrainSize)))[static_cast<std::size_t>(level)]);
  EXPECT_EQ(cells % stride, 0u);
  const std::uint32_t side = cells / stride;
  return {(side + 1) * (side + 1) + 4 * side, 2 * side * side + 8 * side};
}

TEST(EveryModel, OfTerrainAndRocksHasExactSizesForAMillionParameterSets) {
  const Registry registry = make_standard_registry();
  for (const ModelIndex m : {ModelIndex{0}, ModelIndex{1}}) {
    const ModelType& type = registry[m];
    core::RandomStream random(m, 2, 0, 0, core::Purpose::kParameters);
    for (int trial = 0; trial < 500'000; ++trial) {
      const Parameters p = random_parameters(type, random);
      const int level = static_cast<int>(random.next_integer(0, type.level_count() - 1));
      const MeshSize size = type.mesh_size(p, level);
      const auto [vertices, triangles] = count_again(type, p, level);
      ASSERT_EQ(size.vertex_count, vertices);
      ASSERT_EQ(size.triangle_count(), triangles);
      ASSERT_EQ(size.index_count, 3 * triangles);
      if (trial % 100 == 0) synthesise(type, p, level);  // between canaries, of exactly this size
    }
  }
}

TEST(EveryModel, CostsAndErrorsAreOrderedByLevel) {
  for_random_models(20, [](const ModelType& type, const Parameters& p, int level) {
    ASSERT_GT(type.complexity(p, level), 0);
    ASSERT_TRUE(std::isfinite(type.steps(p, level)) && type.steps(p, level) >= 0) << type.name();
    ASSERT_LE(std::log2(type.mesh_size(p, 0).triangle_count()), type.log2_cost(p) + 1e-9)
        << type.name();
    if (level == 0) {
      ASSERT_EQ(type.level_error_m(p, 0), 0);
      return;
    }
    ASSERT_GE(type.level_error_m(p, level), type.level_error_m(p, level - 1)) << type.name();
    ASSERT_LE(type.complexity(p, level), type.complexity(p, level - 1)) << type.name();
    ASSERT_LE(type.mesh_size(p, level).triangle_count(),
              type.mesh_size(p, level - 1).triangle_count());
  });
}

TEST(EveryModel, ListsNoLevelTwice) {
  const Registry registry = make_standard_registry();
  const ModelType& rock = registry[1];
  Parameters rough = default_parameters(rock);
  for (int n = 0; n < rock.level_count(); ++n) {
    rough.set_integer(kRockSubdivisions, n);
    ASSERT_EQ(rock.level_count_of(rough), n + 1);
  }
  for_random_models(8, [](const ModelType& type, const Parameters& p, int level) {
    const int needed = type.level_count_of(p);
    ASSERT_GE(needed, 1);
    ASSERT_LE(needed, type.level_count());
    if (level == 0) return;
    const Mesh mesh = synthesise(type, p, level), before = synthesise(type, p, level - 1);
    if (level >= needed) {
      ASSERT_EQ(mesh.vertex_bytes, before.vertex_bytes) << type.name() << " level " << level;
      ASSERT_EQ(type.level_error_m(p, level), type.level_error_m(p, level - 1));
    } else if (type.name() == "rock") {
      ASSERT_LT(mesh.size.index_count, before.size.index_count) << "level " << level;
    }
  });
}

TEST(EveryModel, HasTheSameBytesOnEveryThreadInAnyOrder) {
  struct Job {
    ModelIndex type;
    Parameters p;
    int level;
  };
  const Registry registry = make_standard_registry();
  std::vector<Job> jobs;
  for (ModelIndex m = 0; m < registry.size(); ++m) {
    core::RandomStream random(m, 1, 0, 0, core::Purpose::kParameters);
    for (int trial = 0; trial < 4; ++trial) {
      const Parameters p = random_parameters(registry[m], random);
      for (int level = 0; level < registry[m].level_count(); ++level)
        jobs.push_back({m, p, level});
    }
  }
  const auto hash = [&](const Job& job) {
    const Mesh mesh = synthesise(registry[job.type], job.p, job.level);
    return core::combine(core::hash_bytes(mesh.vertex_bytes),
                         core::hash_bytes(std::as_bytes(std::span(mesh.indices))));
  };
  std::vector<std::uint64_t> serial;
  for (const Job& job : jobs)
    serial.push_back(hash(job));
  constexpr std::size_t kThreads = 3;
  std::vector<std::uint64_t> parallel(jobs.size());
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < kThreads; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t i = 0; i < jobs.size(); ++i) {
        const std::size_t k = jobs.size() - 1 - i;
        if (k % kThreads == t) parallel[k] = hash(jobs[k]);
      }
    });
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(serial, parallel);
}

TEST(Packing, OctahedralNormalsAreRestored) {
  core::RandomStream random(2, 0, 0, 0, core::Purpose::kPosition);
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 n = glm::normalize(glm::vec3{static_cast<float>(random.next_real(-1, 1)),
                                                 static_cast<float>(random.next_real(-1, 1)),
                                                 static_cast<float>(random.next_real(-1, 1))});
    const glm::vec2 e = encode_octahedral(n);
    const glm::vec2 stored{pack_snorm16(e.x) / 32767.0F, pack_snorm16(e.y) / 32767.0F};
    EXPECT_GT(glm::dot(decode_octahedral(stored), n), 0.999999F);
  }
  EXPECT_EQ(encode_octahedral({0, 1, 0}), glm::vec2(0, 0));
  EXPECT_EQ(encode_octahedral({0, -1, 0}), glm::vec2(1, 1));
}

TEST(Packing, RoundsToNearestAndClamps) {
  EXPECT_EQ(pack_snorm16(2.0F), 32767);
  EXPECT_EQ(pack_snorm16(-1.0F), -32767);
  EXPECT_EQ(pack_unorm8(0.5F), 128);
  EXPECT_EQ(pack_unorm8(-0.1F), 0);
  EXPECT_EQ(pack_albedo(0.25F), 128);
  EXPECT_EQ(round_to_int(-1.5F), -2);
  EXPECT_EQ(round_to_int(2.5F), 2);
  EXPECT_EQ(round_to_int(-1.6F), -2);
}

}  // namespace
}  // namespace psygen::models
