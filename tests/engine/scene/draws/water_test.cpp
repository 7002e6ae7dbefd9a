// Rivers and lakes of a scene: entities of nodes whose meshes are made like those of models.
#include <algorithm>

#include "engine/models/water/water_surface.hpp"
#include "engine/world/edits/edits.hpp"
#include "tests/engine/scene/fixture.hpp"
#include "tests/engine/world/river_world.hpp"

namespace psygen::scene {
namespace {

using world::testing::river_world;

std::unique_ptr<Scene> river_scene() {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 2000;
  return make_scene(river_world(), settings, models::make_standard_registry());
}

// Above the river, 200 m upstream of the lake, which lies to the west.
core::CameraPose pose_over_river(double height_m = 75) {
  core::CameraPose pose;
  pose.position = core::normalised({{0, 0}, {2020, height_m, 1760}}, 64);
  pose.yaw = 4.71;
  pose.pitch = -0.3;
  return pose;
}

struct WaterEntities {
  std::size_t all = 0, drawn = 0, blocks = 0;
};
WaterEntities water_of_scene(const Scene& scene) {
  WaterEntities found;
  state_of(scene).entities.each<const MeshSource, const MeshDemand, const MeshPlacement>(
      [&](auto rows, auto sources, auto demands, auto placed) {
        for (std::size_t i = 0; i < rows.size(); ++i) {
          if (sources[i].index != kWaterIndex) continue;
          EXPECT_EQ(placed[i].surface, core::SurfaceKind::kWater);
          ++found.all;
          found.drawn += demands[i].drawn_level != kNoLevel ? 1 : 0;
          found.blocks += sources[i].parameters.integer(models::kWaterNodeLevel) == 0 ? 1 : 0;
        }
      });
  return found;
}

TEST(WaterOfScene, IsDrawnFromNearAndFar) {
  const auto scene = river_scene();
  scene->settle(pose_over_river());
  tick_at(*scene, pose_over_river());
  const State& s = state_of(*scene);
  const WaterEntities near = water_of_scene(*scene);
  EXPECT_GT(near.blocks, 5U);
  EXPECT_GT(near.all, near.blocks) << "coarse nodes have surfaces, too";
  EXPECT_GT(s.draws.water.size(), 5U);
  EXPECT_EQ(scene->statistics().drawn.holes, 0U);
  for (std::size_t i = 1; i < s.draws.water.size(); ++i)
    EXPECT_TRUE(s.draws.water[i].range.index_count > 0);

  core::CameraPose far = pose_over_river(900);
  far.pitch = -1.2;
  scene->settle(far);
  tick_at(*scene, far);
  EXPECT_GE(s.draws.water.size(), 1U);
}

TEST(WaterOfScene, FollowsADugRiverAndLeavesWithIt) {
  const auto scene = river_scene();
  scene->settle(pose_over_river());
  tick_at(*scene, pose_over_river());
  const WaterEntities before = water_of_scene(*scene);
  ASSERT_GT(before.blocks, 0U);
  // An edit beside the river renews ground and water; nothing is lost.
  world::Edits edits;
  const world::World& world = state_of(*scene).facts.world;
  ASSERT_TRUE(edits.raise(world, core::normalised({{0, 0}, {2000, 0, 1770}}, 64), 30, 3));
  scene->edit(edits);
  for (int i = 0; i < 20; ++i) {
    state_of(*scene).supply.wait();
    tick_at(*scene, pose_over_river());
  }
  const WaterEntities after = water_of_scene(*scene);
  EXPECT_EQ(after.all, before.all);
  EXPECT_EQ(after.drawn, before.drawn);
  expect_consistent(*scene);
  // The same land without water.
  world::World dry = world::testing::parsed(world::testing::kBrookLand);
  ASSERT_TRUE(scene->set_world(dry, models::make_standard_registry()));
  for (int i = 0; i < 20; ++i) {
    state_of(*scene).supply.wait();
    tick_at(*scene, pose_over_river());
  }
  EXPECT_EQ(water_of_scene(*scene).all, 0U);
  EXPECT_TRUE(state_of(*scene).draws.water.empty());
}

}  // namespace
}  // namespace psygen::scene
