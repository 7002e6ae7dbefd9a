// A moving sun: the ground is made anew in steps, and what was drawn stays until then.
#include <set>

#include "engine/models/terrain/terrain.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

struct Ground {
  std::size_t nodes = 0, stale = 0;
  std::set<double> elevations;  // of the sun that nodes are lit by
};

Ground ground_of(const Scene& scene) {
  Ground ground;
  scene.state().entities.each<const Node, const Source, const Demand>(
      [&](std::span<const ecs::Entity>, std::span<const Node>, std::span<const Source> sources,
          std::span<const Demand> demands) {
        for (std::size_t i = 0; i < sources.size(); ++i) {
          ++ground.nodes;
          ground.stale += demands[i].stale ? 1 : 0;
          ground.elevations.insert(sources[i].parameters.real(models::kTerrainSunElevation));
        }
      });
  return ground;
}

TEST(Daylight, WhenTheSunHasMovedAStepTheGroundIsMadeAnewWithoutAHole) {
  models::Registry registry = models::make_standard_registry();
  world::World world = paper_world(registry);
  world.sky.day_length_s = 2400;  // an hour in 100 s
  auto created = Scene::create(world, std::move(registry), small_settings(), nullptr);
  ASSERT_TRUE(created);
  Scene& scene = **created;
  scene.settle(pose_at(256, 256));
  tick_at(scene, pose_at(256, 256));
  const Ground morning = ground_of(scene);
  ASSERT_GT(morning.nodes, 20u);
  EXPECT_EQ(morning.stale, 0u);
  EXPECT_EQ(morning.elevations.size(), 1u);

  scene.state().clock.now_s += 0.1;  // far less than a step
  tick_at(scene, pose_at(256, 256));
  EXPECT_EQ(ground_of(scene).elevations, morning.elevations);

  scene.state().clock.now_s += 150;
  tick_at(scene, pose_at(256, 256));
  const Ground noon = ground_of(scene);
  EXPECT_EQ(noon.elevations.size(), 1u);
  EXPECT_GT(*noon.elevations.begin(), *morning.elevations.begin());
  EXPECT_GT(noon.stale, 0u);
  EXPECT_EQ(scene.state().counters.holes, 0u);

  const synthesis::CacheStats before = scene.state().meshes.stats();
  const double then_s = scene.state().clock.now_s;
  for (int i = 0; i < 40; ++i) {
    scene.state().meshes.wait();
    tick_at(scene, pose_at(256, 256));
    scene.state().clock.now_s = then_s;
    EXPECT_EQ(scene.state().counters.holes, 0u);
  }
  EXPECT_EQ(ground_of(scene).stale, 0u);
  // What is seen already is nothing that was fetched before it is seen.
  EXPECT_EQ(scene.state().meshes.stats().prefetch_hits, before.prefetch_hits);
}

TEST(Daylight, WhatLacksDetailComesBeforeGroundThatIsOnlyLitAnew) {
  const auto scene =
      make_scene_of(small_settings(), [](world::World& world) { world.sky.day_length_s = 2400; });
  State& s = scene->state();
  scene->settle(pose_at(256, 256));
  tick_at(*scene, pose_at(256, 256));
  s.clock.now_s += 150;
  s.settings.max_error_pixels /= 2;
  tick_at(*scene, pose_at(256, 256));
  std::optional<synthesis::Rank> first_lit, last_finer;
  for (const synthesis::Want& want : s.meshes.wants()) {
    const ecs::Entity entity = entity_of(want.owner);
    const Demand& demand = *s.entities.get<Demand>(entity);
    if (demand.in_view_tick + 1 != s.clock.tick) continue;
    if (demand.stale && demand.drawn_level == demand.requested_level) {
      if (!first_lit || want.rank < *first_lit) first_lit = want.rank;
    } else if (demand.drawn_level > demand.requested_level) {
      if (!last_finer || want.rank > *last_finer) last_finer = want.rank;
    }
  }
  ASSERT_TRUE(first_lit && last_finer);
  EXPECT_LT(*last_finer, *first_lit);
}

}  // namespace
}  // namespace psygen::scene
