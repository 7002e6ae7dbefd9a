// A moving sun: the ground is made anew in steps, and what was drawn stays until then.
#include <set>

#include "engine/models/terrain.hpp"
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

  const double then_s = scene.state().clock.now_s;
  for (int i = 0; i < 40; ++i) {
    scene.state().synthesis.manager->wait_all();
    tick_at(scene, pose_at(256, 256));
    scene.state().clock.now_s = then_s;
    EXPECT_EQ(scene.state().counters.holes, 0u);
  }
  EXPECT_EQ(ground_of(scene).stale, 0u);
}

}  // namespace
}  // namespace psygen::scene
