#include "engine/physics/buoyancy.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "tests/engine/physics/scene.hpp"
#include "tests/engine/world/river_world.hpp"

namespace psygen::physics {
namespace {

using testing::ball;
using testing::box;
using testing::Scene;

Scene in_river() {
  return Scene(query::testing::Loaded::parsed(world::testing::river_text()));
}
core::WorldPosition position_in(const Scene& scene, glm::dvec2 at_m, double height_m) {
  core::WorldPosition at = scene.loaded.world.position(at_m);
  at.local.y = height_m;
  return at;
}
constexpr glm::dvec2 kOnLake{1740, 1680}, kOnSea{1540, 1650}, kOnRiver{1905, 1715};

TEST(Displacement, IsTheVolumeOfAllParts) {
  models::Collider all = box({1, 2, 3});
  EXPECT_NEAR(displacement_of(all).volume_m3, 48, 1e-6);
  EXPECT_EQ(displacement_of(all).half, glm::dvec3(1, 2, 3));
  EXPECT_NEAR(displacement_of(ball(2)).volume_m3, 32.0 / 3 * std::numbers::pi, 1e-6);
  all.shapes.emplace_back(models::Collider::Capsule{{0, 4, 0}, {0, 6, 0}, 1});
  EXPECT_NEAR(displacement_of(all).volume_m3, 48 + 10.0 / 3 * std::numbers::pi, 1e-5);
  models::Collider hull;
  hull.shapes.emplace_back(
      models::Collider::Hull{{{0, 0, 0}, {3, 0, 0}, {0, 4, 0}, {0, 0, 5}, {0.2F, 0.2F, 0.2F}}});
  EXPECT_NEAR(displacement_of(hull).volume_m3, 10, 1e-5);
}

TEST(Buoyancy, LightBodiesFloatAtTheirDensityAndHeavyOnesSink) {
  Scene scene = in_river();
  const double level_m =
      world::water_surface(scene.loaded.world, position_in(scene, kOnLake, 0))->surface_m;
  struct Case {
    double mass_kg, above_m;  // of the middle of a slab of 0.5 m over the surface
  };
  for (const auto [mass_kg, above_m] : {Case{125, 0.125}, Case{250, 0}, Case{400, -0.15}}) {
    const auto body =
        scene.physics.add(BodySettings{.shape = box({0.5F, 0.25F, 0.5F}),
                                       .position = position_in(scene, kOnLake, level_m + 1),
                                       .mass_kg = mass_kg});
    ASSERT_TRUE(body) << body.error().message;
    scene.steps(900);
    const BodyState state = *scene.physics.state(*body);
    EXPECT_NEAR(state.position.local.y - level_m, above_m, 0.03) << mass_kg;
    EXPECT_LT(glm::length(state.velocity), 0.05) << mass_kg;
    ASSERT_TRUE(scene.physics.remove(*body));
  }
  const auto stone = scene.physics.add(BodySettings{
      .shape = ball(0.3F), .position = position_in(scene, kOnLake, level_m + 1), .mass_kg = 300});
  ASSERT_TRUE(stone);
  scene.steps(600);
  EXPECT_LT(scene.physics.state(*stone)->position.local.y, level_m - 4);
}

TEST(Buoyancy, AVeryLightBodyStaysCalm) {
  Scene scene = in_river();
  const auto body = scene.physics.add(BodySettings{
      .shape = ball(0.5F), .position = position_in(scene, kOnSea, 24.5), .mass_kg = 0.1});
  ASSERT_TRUE(body);
  double highest_m = 0;
  for (int i = 0; i < 600; ++i) {
    ASSERT_TRUE(scene.physics.step(testing::kStep));
    highest_m = std::max(highest_m, scene.physics.state(*body)->position.local.y);
  }
  EXPECT_LT(highest_m, 30);
  EXPECT_NEAR(scene.physics.state(*body)->position.local.y, 26.25 + 0.4, 0.15);
}

TEST(Buoyancy, ALyingPlankComesBackToItsFlatSide) {
  Scene scene = in_river();
  const auto body =
      scene.physics.add(BodySettings{.shape = box({1, 0.1F, 0.5F}),
                                     .position = position_in(scene, kOnSea, 26.2),
                                     .rotation = glm::dquat(std::cos(0.35), 0, 0, std::sin(0.35)),
                                     .mass_kg = 160});
  ASSERT_TRUE(body);
  scene.steps(900);
  const glm::dvec3 up = scene.physics.state(*body)->rotation * glm::dvec3(0, 1, 0);
  EXPECT_GT(std::abs(up.y), 0.98);
}

TEST(Buoyancy, TheCurrentCarriesBodiesDownstream) {
  Scene scene = in_river();
  const core::WorldPosition start = position_in(scene, kOnRiver, 0);
  const auto water = world::water_surface(scene.loaded.world, start);
  ASSERT_TRUE(water);
  const double speed = glm::length(glm::dvec2(water->flow_m_s));
  ASSERT_GT(speed, 0.3);
  core::WorldPosition at = start;
  at.local.y = water->surface_m + 0.1;
  const auto body =
      scene.physics.add(BodySettings{.shape = ball(0.15F), .position = at, .mass_kg = 4});
  ASSERT_TRUE(body);
  scene.steps(300);
  const BodyState state = *scene.physics.state(*body);
  const glm::dvec3 way = core::offset_m(state.position.block, start, 64) + state.position.local;
  EXPECT_GT(glm::dot(glm::dvec2(way.x, way.z), glm::dvec2(water->flow_m_s)) / speed, speed * 2);
  EXPECT_LT(state.position.local.y, start.local.y + water->surface_m + 0.2);
}

TEST(Buoyancy, WaterWithoutDensityHasNoEffect) {
  Scene scene(query::testing::Loaded::parsed(world::testing::river_text()), {.water_kg_m3 = 0});
  const auto body = scene.physics.add(
      BodySettings{.shape = ball(0.3F), .position = position_in(scene, kOnLake, 31), .mass_kg = 1});
  ASSERT_TRUE(body);
  scene.steps(300);
  EXPECT_LT(scene.physics.state(*body)->position.local.y, 26);
  for (const double density : {-1.0, 20'001.0, testing::kNan}) {
    const auto wrong = World::create(scene.query, {.water_kg_m3 = density});
    ASSERT_FALSE(wrong);
    EXPECT_NE(wrong.error().message.find("density of water"), std::string::npos);
  }
}

TEST(Buoyancy, TheSameCallsGiveTheSameBits) {
  std::vector<double> all[2];
  for (auto& values : all) {
    Scene scene = in_river();
    const auto body = scene.physics.add(BodySettings{.shape = box({0.4F, 0.2F, 0.3F}),
                                                     .position = position_in(scene, kOnRiver, 52),
                                                     .mass_kg = 40});
    ASSERT_TRUE(body);
    for (int i = 0; i < 200; ++i) {
      ASSERT_TRUE(scene.physics.step(testing::kStep));
      const BodyState s = *scene.physics.state(*body);
      for (const double v :
           {s.position.local.x, s.position.local.y, s.position.local.z, s.rotation.w, s.velocity.x})
        values.push_back(v);
    }
  }
  EXPECT_EQ(all[0], all[1]);
}

TEST(Character, FloatsWithItsHeadAboveDeepWater) {
  Scene scene = in_river();
  const auto id = scene.physics.add(CharacterSettings{.feet = position_in(scene, kOnLake, 31)});
  ASSERT_TRUE(id);
  scene.steps(900);
  const double level_m =
      world::water_surface(scene.loaded.world, position_in(scene, kOnLake, 0))->surface_m;
  const CharacterState state = *scene.physics.state(*id);
  EXPECT_NEAR(state.feet.local.y, level_m - 0.9 * 1.8, 0.1);
  EXPECT_FALSE(state.on_ground);
  // It swims with its usual input, and wades out.
  ASSERT_TRUE(scene.physics.tell(*id, {.direction = {0, -1}, .run = true}));
  scene.steps(1500);
  EXPECT_TRUE(scene.physics.state(*id)->on_ground);
}

TEST(Character, TheCurrentCarriesItAndStillWaterDoesNot) {
  Scene scene = in_river();
  const core::WorldPosition start = position_in(scene, {1640, 1658}, 0);
  const auto water = world::water_surface(scene.loaded.world, start);
  ASSERT_TRUE(water);
  ASSERT_GT(glm::length(glm::dvec2(water->flow_m_s)), 0.3);
  core::WorldPosition feet = start;
  feet.local.y = water->surface_m - 1;
  const auto wading = scene.physics.add(CharacterSettings{.feet = feet});
  const auto ashore =
      scene.physics.add(CharacterSettings{.feet = position_in(scene, {1650, 1700}, 60)});
  const auto floating =
      scene.physics.add(CharacterSettings{.feet = position_in(scene, kOnLake, 31)});
  ASSERT_TRUE(wading && ashore && floating);
  scene.steps(300);
  const auto moved_m = [&](CharacterId id, const core::WorldPosition& from) {
    const core::WorldPosition to = scene.physics.state(id)->feet;
    const glm::dvec3 way = core::offset_m(to.block, from, 64) + to.local;
    return std::hypot(way.x, way.z);
  };
  EXPECT_GT(moved_m(*wading, start), 0.5);
  EXPECT_LT(moved_m(*ashore, position_in(scene, {1650, 1700}, 0)), 0.01);
  EXPECT_LT(moved_m(*floating, position_in(scene, kOnLake, 0)), 0.01);
}

}  // namespace
}  // namespace psygen::physics
