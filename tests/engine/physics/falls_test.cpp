// Nothing ever falls through the ground: fast falls, random teleports, borders of blocks and
// worlds, steep slopes, many bodies.
#include <cmath>
#include <glm/geometric.hpp>

#include "tests/engine/physics/scene.hpp"

namespace psygen::physics {
namespace {

using testing::ball;
using testing::box;
using testing::kBounded;
using testing::kStep;
using testing::kWorldNames;
using testing::Loaded;
using testing::Scene;

class Falls : public ::testing::TestWithParam<const char*> {
 protected:
  static Loaded world() {
    const std::string name = GetParam();
    return name == "bounded" ? Loaded::parsed(kBounded) : Loaded::shipped(name);
  }
  // A position in the world; every other one on a border of blocks or at the world's edge. Land of
  // a river network takes 30 ms where none is near, so most positions there are in one place.
  static core::WorldPosition random_place(Scene& scene, core::RandomStream& random, int i) {
    const world::World& w = scene.loaded.world;
    const auto index = [&](std::int64_t blocks) {
      if (blocks == 0 && w.network() != nullptr && i >= 100)
        return static_cast<std::int32_t>(random.next_integer(-20, 20));
      if (blocks == 0) return static_cast<std::int32_t>(random.next_integer(-(1 << 30), 1 << 30));
      if (i % 8 == 3) return static_cast<std::int32_t>(random.next_unit() < 0.5 ? 0 : blocks - 1);
      return static_cast<std::int32_t>(random.next_integer(0, blocks - 1));
    };
    core::BlockCoord block{index(w.blocks_x), index(w.blocks_z)};
    const double size = w.block_size_m();
    double x = random.next_real(0, size), z = random.next_real(0, size);
    if (i % 2 == 1) x = random.next_unit() < 0.5 ? 0 : std::nextafter(size, 0);
    if (i % 4 == 3) z = random.next_unit() < 0.5 ? 0 : std::nextafter(size, 0);
    return scene.above(block, x, z, 0);
  }
};

INSTANTIATE_TEST_SUITE_P(, Falls,
                         ::testing::Values("paper", "endless", "frost_isle", "ember_pass", "lakes",
                                           "silver_combe", "five_species", "bounded"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(Falls, CharactersThatAreTeleportedAndDroppedStayAboveTheGround) {
  Scene scene(world());
  core::RandomStream random(1, 0, 0, 0, core::Purpose::kPosition);
  const auto id = scene.physics.add(CharacterSettings{.feet = random_place(scene, random, 0)});
  ASSERT_TRUE(id);
  for (int i = 0; i < 1000; ++i) {
    core::WorldPosition at = random_place(scene, random, i);
    at.local.y += random.next_real(-100, 60);
    ASSERT_TRUE(scene.physics.set_feet(*id, at));
    const auto speed = [&] { return random.next_real(-200, 200); };
    ASSERT_TRUE(scene.physics.set_velocity(*id, {speed(), -random.next_real(0, 900), speed()}));
    ASSERT_TRUE(
        scene.physics.tell(*id, {{random.next_real(-1, 1), random.next_real(-1, 1)}, true}));
    for (int k = 0; k < 12; ++k) {
      ASSERT_TRUE(scene.physics.step(kStep));
      const CharacterState s = *scene.physics.state(*id);
      ASSERT_TRUE(scene.loaded.world.contains(s.feet.block)) << i;
      ASSERT_GE(s.feet.local.y, scene.ground_m(s.feet) - 1e-5) << i;
    }
  }
}

TEST_P(Falls, BodiesThatAreThrownAtTheGroundStayAboveIt) {
  Scene scene(world());
  core::RandomStream random(2, 0, 0, 0, core::Purpose::kPosition);
  std::vector<BodyId> bodies;
  for (int i = 0; i < 20; ++i) {
    const auto size = static_cast<float>(0.05 * std::pow(1.2, i));  // 0.05 … 1.6 m
    const auto id = scene.physics.add(
        {.shape = i % 2 == 0 ? ball(size) : box(glm::vec3(size, 0.5F * size, 2 * size)),
         .position = random_place(scene, random, i)});
    ASSERT_TRUE(id);
    bodies.push_back(*id);
  }
  for (int round = 0; round < 25; ++round) {
    // All near one position, so that they collide, and so that coordinates are exact.
    const core::WorldPosition centre = random_place(scene, random, round);
    for (const BodyId id : bodies) {
      core::WorldPosition at = centre;
      at.local.y += random.next_real(2, 40);
      ASSERT_TRUE(scene.physics.set_pose(id, at, {1, 0, 0, 0}));
      const auto speed = [&] { return random.next_real(-300, 300); };
      ASSERT_TRUE(scene.physics.set_velocity(id, {speed(), -random.next_real(0, 900), speed()},
                                             {speed() / 10, 0, 3}));
    }
    for (int k = 0; k < 30; ++k) {
      ASSERT_TRUE(scene.physics.step(kStep));
      for (const BodyId id : bodies) {
        const BodyState s = *scene.physics.state(id);
        ASSERT_TRUE(scene.loaded.world.contains(s.position.block));
        ASSERT_GE(s.position.local.y, scene.ground_m(s.position) - 1e-4) << round << " " << k;
        ASSERT_LE(glm::length(s.velocity), kMaxSpeed * 1.001);
      }
    }
  }
}

TEST(FallsAtTheEdge, ActorsStopBeforeTheSeamOfAnEndlessWorld) {
  for (const auto& [block, east] : {std::pair{INT32_MAX, 1}, {INT32_MIN, -1}}) {
    Scene scene(Loaded::shipped("endless"));
    const double size = scene.loaded.world.block_size_m();
    const double near_m = east > 0 ? size - 3 : 3, seam_m = east > 0 ? size : 0;
    const auto id =
        scene.physics.add(CharacterSettings{.feet = scene.above({block, 7}, near_m, 30, 0)});
    const auto ball_id = scene.physics.add(
        {.shape = testing::ball(0.5F), .position = scene.above({block, 7}, near_m, 40, 1)});
    ASSERT_TRUE(id && ball_id);
    for (int i = 0; i < 120; ++i) {
      ASSERT_TRUE(scene.physics.set_velocity(*id, {20.0 * east, 0, 0}));
      ASSERT_TRUE(scene.physics.set_velocity(*ball_id, {30.0 * east, 0, 0}, {}));
      scene.steps(1);
      ASSERT_EQ(scene.physics.state(*id)->feet.block.x, block) << i;
      ASSERT_EQ(scene.physics.state(*ball_id)->position.block.x, block) << i;
    }
    EXPECT_LT(std::abs(scene.physics.state(*id)->feet.local.x - seam_m), 1.0);
    const core::WorldPosition across = scene.above({INT32_MAX + INT32_MIN - block, 7}, 20, 30, 0);
    EXPECT_FALSE(scene.physics.add(CharacterSettings{.feet = across}));
    EXPECT_FALSE(scene.physics.set_feet(*id, across));
    EXPECT_LT(std::abs(scene.physics.state(*ball_id)->position.local.x - seam_m), 1.0);
  }
}

TEST(FallsAtTheEdge, ActorsDoNotLeaveABoundedWorld) {
  Scene scene(Loaded::parsed(kBounded));
  for (const glm::dvec2& way : {glm::dvec2(1, 0), {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}}) {
    const auto id = scene.physics.add(CharacterSettings{.feet = scene.above({4, 2}, 1, 1, 1)});
    const auto body = scene.physics.add({.shape = ball(0.4F),
                                         .position = scene.above({4, 2}, 9, 9, 5),
                                         .velocity = glm::dvec3(way.x, 0.3, way.y) * 200.0});
    ASSERT_TRUE(id && body);
    for (int i = 0; i < 400; ++i) {
      ASSERT_TRUE(scene.physics.set_velocity(*id, {way.x * 40, 0, way.y * 40}));
      ASSERT_TRUE(scene.physics.step(kStep));
      ASSERT_TRUE(scene.loaded.world.contains(scene.physics.state(*id)->feet.block));
      const BodyState s = *scene.physics.state(*body);
      ASSERT_TRUE(scene.loaded.world.contains(s.position.block));
      ASSERT_GE(s.position.local.y, scene.ground_m(s.position) - 1e-4);
    }
    ASSERT_TRUE(scene.physics.remove(*id));
    ASSERT_TRUE(scene.physics.remove(*body));
  }
}

TEST(FallsOfMany, CharactersAndBodiesFarApartStayOnTheGround) {
  Scene scene(Loaded::shipped("silver_combe"));
  std::vector<CharacterId> characters;
  std::vector<BodyId> bodies;
  for (int i = 0; i < 40; ++i) {
    const core::BlockCoord block{i * 97 - 1500, 5 * i * i};
    characters.push_back(
        *scene.physics.add(CharacterSettings{.feet = scene.above(block, 20, 20, 30)}));
    bodies.push_back(*scene.physics.add({.shape = ball(0.3F),
                                         .position = scene.above(block, 40, 40, 200),
                                         .velocity = {0, -200, 0}}));
  }
  for (int i = 0; i < 240; ++i) {
    ASSERT_TRUE(scene.physics.step(kStep));
    if (i % 20 != 0) continue;
    for (const BodyId id : bodies) {
      const BodyState s = *scene.physics.state(id);
      ASSERT_GE(s.position.local.y, scene.ground_m(s.position) - 1e-4);
    }
  }
  for (const CharacterId id : characters) {
    const CharacterState s = *scene.physics.state(id);
    EXPECT_GE(s.feet.local.y, scene.ground_m(s.feet) - 1e-5);
    EXPECT_LE(s.feet.local.y, scene.ground_m(s.feet) + 15);  // the end of a trunk at most
  }
  EXPECT_LE(scene.physics.block_count(), 80U * 9 + 64);
}

}  // namespace
}  // namespace psygen::physics
