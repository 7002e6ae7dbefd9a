// A moving sun renews the ground in steps; old meshes are drawn until the new ones are ready.
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
  state_of(scene).entities.each<const QuadtreeNode, const MeshSource, const MeshDemand>(
      [&](std::span<const ecs::Entity>, std::span<const QuadtreeNode>,
          std::span<const MeshSource> sources, std::span<const MeshDemand> demands) {
        for (std::size_t i = 0; i < sources.size(); ++i) {
          ++ground.nodes;
          ground.stale += demands[i].stale ? 1 : 0;
          ground.elevations.insert(sources[i].parameters.real(models::kTerrainSunElevation));
        }
      });
  return ground;
}

TEST(Daylight, ASunThatMovesByAStepRenewsTheGroundWithoutAHole) {
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

  state_of(scene).clock.now_s += 0.1;  // far less than a step
  tick_at(scene, pose_at(256, 256));
  EXPECT_EQ(ground_of(scene).elevations, morning.elevations);

  state_of(scene).clock.now_s += 150;
  tick_at(scene, pose_at(256, 256));
  const Ground noon = ground_of(scene);
  EXPECT_EQ(noon.elevations.size(), 1u);
  EXPECT_GT(*noon.elevations.begin(), *morning.elevations.begin());
  EXPECT_GT(noon.stale, 0u);
  EXPECT_EQ(scene.statistics().drawn.holes, 0u);

  const synthesis::CacheStats before = state_of(scene).supply.stats();
  const double then_s = state_of(scene).clock.now_s;
  for (int i = 0; i < 40; ++i) {
    state_of(scene).supply.wait();
    tick_at(scene, pose_at(256, 256));
    state_of(scene).clock.now_s = then_s;
    EXPECT_EQ(scene.statistics().drawn.holes, 0u);
  }
  EXPECT_EQ(ground_of(scene).stale, 0u);
  // Ground in view was not prefetched.
  EXPECT_EQ(state_of(scene).supply.stats().prefetch_hits, before.prefetch_hits);
}

TEST(Daylight, MissingDetailComesBeforeNewLightOnGround) {
  const auto scene =
      make_scene_of(small_settings(), [](world::World& world) { world.sky.day_length_s = 2400; });
  State& s = state_of(*scene);
  scene->settle(pose_at(256, 256));
  tick_at(*scene, pose_at(256, 256));
  s.clock.now_s += 150;
  s.settings.max_error_pixels /= 2;
  tick_at(*scene, pose_at(256, 256));
  std::optional<synthesis::Rank> first_lit, last_finer;
  for (const synthesis::Want& want : s.supply.wants()) {
    const ecs::Entity entity = entity_of(want.owner);
    const MeshDemand& demand = *s.entities.get<MeshDemand>(entity);
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
