// Tests the standard models through the whole pipeline: plan, modelers, cache, hash.
#include <gtest/gtest.h>

#include "engine/core/geometry_memory.hpp"
#include "engine/synthesis/content_hash.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/synthesis/planner.hpp"

namespace psygen::synthesis {
namespace {

struct World {
  std::vector<models::Parameters> parameters;
  std::vector<Want> wants;
};

// A few models of every type and level; placed parameters get different values.
World small_world(const models::Registry& registry) {
  World world;
  world.parameters.reserve(1024);
  for (std::size_t m = 0; m < registry.size(); ++m) {
    const auto model = static_cast<models::ModelIndex>(m);
    const models::ModelType& type = registry[model];
    const int seed = models::parameter_index(type, "seed");
    for (std::uint32_t i = 0; i < 4; ++i) {
      models::Parameters p = models::default_parameters(type);
      if (seed >= 0) p.set_integer(static_cast<std::size_t>(seed), 17 + i);
      world.parameters.push_back(p);
      for (int level = 0; level < type.level_count(); ++level) {
        const MeshKey key{{0, 0}, i, model, static_cast<std::uint16_t>(level), p.hash()};
        world.wants.push_back({key, &world.parameters.back(), world.wants.size(),
                               Rank::by_layer(RankGroup::kVisibleHole, i, 1.0F)});
      }
    }
  }
  return world;
}

std::uint64_t synthesise(const models::Registry& registry, std::vector<Want> wants,
                         unsigned modelers, Policy policy) {
  core::HeapGeometryMemory memory(std::uint64_t{1} << 28);
  GeometryCache cache(memory, registry, std::uint64_t{1} << 28);
  CostModel cost(registry);
  SynthesisManager manager(registry,
                           {.modelers = modelers, .hash_content = true, .watchdog_seconds = 0});
  Planner planner;
  const PlanReport report =
      planner.plan(wants, cache, cost, manager, {1e9, UINT32_MAX, 16}, policy);
  EXPECT_EQ(report.published, wants.size());
  EXPECT_TRUE(manager.wait_all());
  std::vector<Completion> done;
  manager.collect(done);
  EXPECT_EQ(land(done, cache, &cost).ready, wants.size());
  WorldHash hash;
  for (const Completion& c : done) {
    EXPECT_TRUE(c.ok) << c.error;
    const MeshRecord* record = cache.get(c.handle);
    const core::Bounds box = registry[c.key.model].bounds(*wants[c.owner].parameters);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(record->tight.min[axis], box.min[axis] - 1e-3F) << registry[c.key.model].name();
      EXPECT_LE(record->tight.max[axis], box.max[axis] + 1e-3F) << registry[c.key.model].name();
    }
    hash.add(c.content_hash);
  }
  return hash.value();
}

TEST(RealModels, OneToFourModelersUnderAnyPolicyMakeTheSameWorld) {
  const models::Registry registry = models::make_standard_registry();
  ASSERT_GT(registry.size(), 0u);
  const World world = small_world(registry);
  const std::uint64_t serial = synthesise(registry, world.wants, 1, Policy::kFifo);
  EXPECT_EQ(synthesise(registry, world.wants, 2, Policy::kShortest), serial);
  EXPECT_EQ(synthesise(registry, world.wants, 3, Policy::kLongest), serial);
  std::vector<Want> reversed(world.wants.rbegin(), world.wants.rend());
  for (std::size_t i = 0; i < reversed.size(); ++i)
    reversed[i].owner = i;
  EXPECT_EQ(synthesise(registry, reversed, 4, Policy::kFifo), serial);
}

TEST(RealModels, CalibrationMeasuresEveryTypeAndLevel) {
  const models::Registry registry = models::make_standard_registry();
  CostModel cost(registry);
  CalibrationOptions options;
  options.seconds_limit = 60;  // a slow machine or a sanitizer must not change the outcome
  const CalibrationReport report = cost.calibrate({}, options);
  EXPECT_TRUE(report.failures.empty());
  for (const LevelCalibration& level : report.levels) {
    EXPECT_EQ(level.samples, 1u) << registry[level.model].name() << " " << level.level;
    EXPECT_GT(level.fit.per_operation_s, 0);
  }
}

}  // namespace
}  // namespace psygen::synthesis
