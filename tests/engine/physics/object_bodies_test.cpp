// Objects of a game in physics: they carry and push bodies and characters.
#include <cmath>
#include <numbers>

#include "tests/engine/physics/scene.hpp"

namespace psygen::physics {
namespace {

using testing::kStep;
using testing::Loaded;
using testing::Scene;

// A world with objects, and platforms whose top is at a given height above the ground.
struct Platforms : Scene {
  query::Objects objects;
  query::ObjectTag last_name = 0;

  Platforms() : Scene(Loaded::shipped("paper")), objects(loaded.world) { query.meet(&objects); }
  core::WorldPosition place(double height_m, double x = 30, double z = 30) {
    return above({200, 200}, x, z, height_m);
  }
  query::ObjectId put(const models::Collider& collider, const core::WorldPosition& at) {
    const auto id =
        objects.add(++last_name, *query::Objects::make_shape(collider), {.position = at});
    EXPECT_TRUE(id) << id.error().message;
    return id.value_or(query::ObjectId());
  }
  // Adds a slab with its top at `top`.
  query::ObjectId slab(core::WorldPosition top, double half_m = 4) {
    top.local.y -= 0.25;
    const auto half = static_cast<float>(half_m);
    return put(testing::box({half, 0.25F, half}), top);
  }
  void move(query::ObjectId id, const glm::dvec3& way, double turn = 0) {
    query::ObjectPose pose = objects.find(id)->pose;
    pose.position.local += way;
    pose.rotation = glm::angleAxis(turn, glm::dvec3(0, 1, 0)) * pose.rotation;
    ASSERT_TRUE(objects.move(id, pose));
  }
  CharacterId character(const core::WorldPosition& feet) {
    return *physics.add(CharacterSettings{.feet = feet});
  }
  CharacterState at(CharacterId id) { return *physics.state(id); }
  BodyId crate(const core::WorldPosition& where) {
    return *physics.add(
        BodySettings{.shape = testing::box(glm::vec3(0.25F)), .position = where, .mass_kg = 20});
  }
};

// A position some metres east of a point on a platform, and a little above it.
core::WorldPosition beside(core::WorldPosition top, double metres) {
  top.local += glm::dvec3(metres, 0.3, 0);
  return top;
}

TEST(ObjectBodies, CarryACharacterUntilTheyDisappear) {
  Platforms s;
  const auto top = s.place(20);
  const query::ObjectId slab = s.slab(top);
  const CharacterId id = s.character(s.place(21));
  s.steps(120);
  EXPECT_TRUE(s.at(id).on_ground);
  EXPECT_NEAR(s.at(id).feet.local.y, top.local.y, 0.02);
  s.objects.remove(slab);
  s.steps(30);
  EXPECT_FALSE(s.at(id).on_ground);
  s.steps(200);
  EXPECT_TRUE(s.at(id).on_ground);
  EXPECT_NEAR(s.at(id).feet.local.y, s.ground_m(s.at(id).feet), 1e-6);
}

TEST(ObjectBodies, StopACharacterLikeAWallAndLetItClimbALowStep) {
  Platforms s;
  const auto floor = s.place(60);
  s.slab(floor, 20);
  auto wall = floor, step = floor;
  wall.local += glm::dvec3(5, 1, 0);
  step.local += glm::dvec3(-5, 0.1, 0);
  s.put(testing::box({0.5F, 1, 4}), wall);
  s.put(testing::box({1, 0.1F, 4}), step);
  const CharacterId id = s.character(floor);
  ASSERT_TRUE(s.physics.tell(id, {{1, 0}, true}));
  s.steps(180);
  EXPECT_NEAR(s.at(id).feet.local.x, floor.local.x + 4.5 - 0.3, 0.05);
  ASSERT_TRUE(s.physics.tell(id, {{-1, 0}}));
  double highest = 0;
  for (int i = 0; i < 600; ++i) {
    s.steps(1);
    highest = std::max(highest, s.at(id).feet.local.y - floor.local.y);
  }
  EXPECT_NEAR(highest, 0.2, 0.03);
  EXPECT_LT(s.at(id).feet.local.x, floor.local.x - 6);
}

TEST(ObjectBodies, MoveACharacterUpDownSidewaysAndAround) {
  Platforms s;
  auto top = s.place(20);
  const query::ObjectId slab = s.slab(top);
  const CharacterId id = s.character(beside(top, 2));
  s.steps(60);
  for (const glm::dvec3 speed :
       {glm::dvec3(0, 2, 0), glm::dvec3(3, 0, 1), glm::dvec3(0, -3, 0), glm::dvec3(-3, 0.5, -1)}) {
    const glm::dvec3 before = s.at(id).feet.local;
    for (int i = 0; i < 60; ++i) {
      s.move(slab, speed * kStep);
      s.steps(1);
      ASSERT_TRUE(s.at(id).on_ground);
    }
    const glm::dvec3 way = s.at(id).feet.local - before;
    EXPECT_NEAR(way.x, speed.x, 0.05);
    EXPECT_NEAR(way.y, speed.y, 0.05);
    EXPECT_NEAR(way.z, speed.z, 0.05);
  }
  // Half a turn around the slab's middle, 2 m away.
  const glm::dvec3 middle = s.objects.find(slab)->pose.position.local;
  const glm::dvec3 before = s.at(id).feet.local;
  for (int i = 0; i < 120; ++i) {
    s.move(slab, {0, 0, 0}, std::numbers::pi / 120);
    s.steps(1);
  }
  EXPECT_NEAR(s.at(id).feet.local.x, 2 * middle.x - before.x, 0.05);
  EXPECT_NEAR(s.at(id).feet.local.z, 2 * middle.z - before.z, 0.05);
}

TEST(ObjectBodies, ACharacterThatJumpsOffKeepsTheirVelocity) {
  Platforms s;
  const query::ObjectId slab = s.slab(s.place(20), 8);
  const CharacterId id = s.character(s.place(20.1));
  s.steps(30);
  for (int i = 0; i < 60; ++i) {
    s.move(slab, {5 * kStep, 0, 0});
    s.steps(1);
  }
  ASSERT_TRUE(s.physics.tell(id, {.jump = true}));
  s.move(slab, {5 * kStep, 0, 0});
  s.steps(1);
  EXPECT_FALSE(s.at(id).on_ground);
  EXPECT_GT(s.at(id).velocity.x, 4.5);
  EXPECT_GT(s.at(id).velocity.y, 4);
}

TEST(ObjectBodies, PushACharacterOutOfTheirWay) {
  Platforms s;
  const auto floor = s.place(60);
  s.slab(floor, 20);
  auto wall = floor;
  wall.local += glm::dvec3(-3, 1, 0);
  const query::ObjectId mover = s.put(testing::box({0.5F, 1, 4}), wall);
  const CharacterId id = s.character(floor);
  for (int i = 0; i < 180; ++i) {
    s.move(mover, {2 * kStep, 0, 0});
    s.steps(1);
  }
  EXPECT_GT(s.at(id).feet.local.x, floor.local.x + 3.5);
  EXPECT_NEAR(s.at(id).feet.local.y, floor.local.y, 0.05);
}

TEST(ObjectBodies, CarryBodiesThatFallWhenTheyAreRemoved) {
  Platforms s;
  const auto top = s.place(20);
  const query::ObjectId slab = s.slab(top);
  const BodyId crate = s.crate(s.place(20.5));
  s.steps(300);
  ASSERT_TRUE(s.physics.state(crate)->asleep);
  EXPECT_NEAR(s.physics.state(crate)->position.local.y, top.local.y + 0.25, 0.05);
  const double before = s.physics.state(crate)->position.local.x;
  for (int i = 0; i < 120; ++i) {
    s.move(slab, {1 * kStep, 0, 0});
    s.steps(1);
  }
  EXPECT_NEAR(s.physics.state(crate)->position.local.x, before + 2, 0.3);
  s.steps(300);
  ASSERT_TRUE(s.physics.state(crate)->asleep);
  s.objects.remove(slab);
  s.steps(200);
  const auto fallen = s.physics.state(crate)->position;
  EXPECT_LT(fallen.local.y, s.ground_m(fallen) + 1);
  EXPECT_GT(fallen.local.y, s.ground_m(fallen));
}

TEST(ObjectBodies, PushOutACharacterWhenTheyAppear) {
  Platforms s;
  const auto floor = s.place(60);
  s.slab(floor, 20);
  const CharacterId id = s.character(floor);
  s.steps(30);
  auto inside = floor;
  inside.local += glm::dvec3(0.4, 1, 0);
  s.put(testing::box({0.3F, 1, 0.3F}), inside);
  s.steps(60);
  const glm::dvec3 away = s.at(id).feet.local - floor.local;
  EXPECT_LT(std::abs(away.x) + std::abs(away.z), 3);
  EXPECT_LT(away.x, -0.1);
}

TEST(ObjectBodies, ThatJumpFarCarryAndThrowNothing) {
  Platforms s;
  const auto top = s.place(20);
  const query::ObjectId slab = s.slab(top);
  const CharacterId id = s.character(top);
  const BodyId crate = s.crate(beside(top, 2));
  s.steps(60);
  const double x = s.at(id).feet.local.x;
  s.move(slab, {500, 0, 0});
  s.steps(2);
  EXPECT_NEAR(s.at(id).feet.local.x, x, 0.1);
  s.steps(300);
  EXPECT_NEAR(s.at(id).feet.local.y, s.ground_m(s.at(id).feet), 1e-6);
  const auto fallen = s.physics.state(crate)->position;
  EXPECT_LT(fallen.local.y, s.ground_m(fallen) + 1);
}

TEST(ObjectBodies, ChangeTheirSizeImmediately) {
  Platforms s;
  const query::ObjectId slab = s.slab(s.place(20));
  const CharacterId id = s.character(s.place(20.1));
  s.steps(30);
  query::ObjectPose pose = s.objects.find(slab)->pose;
  pose.scale = {1, 3, 1};  // its top is 0.5 m higher
  const double before = s.at(id).feet.local.y;
  ASSERT_TRUE(s.objects.move(slab, pose));
  s.steps(20);
  EXPECT_NEAR(s.at(id).feet.local.y, before + 0.5, 0.05);
  EXPECT_TRUE(s.at(id).on_ground);
}

TEST(ObjectBodies, DoNotPressActorsThroughTheGround) {
  Platforms s;
  const CharacterId id = s.character(s.place(0));
  const BodyId crate = s.crate(s.place(0.3, 31, 30));
  const query::ObjectId press = s.slab(s.place(6));
  for (int i = 0; i < 240; ++i) {
    s.move(press, {0, -2 * kStep, 0});
    s.steps(1);
    ASSERT_GE(s.at(id).feet.local.y, s.ground_m(s.at(id).feet) - 1e-6);
    const auto pressed = s.physics.state(crate)->position;
    ASSERT_GE(pressed.local.y, s.ground_m(pressed) - 1e-6);
  }
}

TEST(ObjectBodies, TheSameCallsGiveTheSameBits) {
  const auto run = [] {
    Platforms s;
    std::vector<query::ObjectId> slabs;
    for (int i = 0; i < 30; ++i)
      slabs.push_back(s.slab(s.place(5 + i % 7, 20 + i, 30), 2));
    const CharacterId id = s.character(s.place(14));
    std::vector<BodyId> crates;
    for (int i = 0; i < 20; ++i)
      crates.push_back(s.crate(s.place(16 + i, 25 + i, 30)));
    (void)s.physics.tell(id, {{1, 0.2}, true});
    for (int i = 0; i < 200; ++i) {
      for (std::size_t k = 0; k < slabs.size(); ++k)
        s.move(slabs[k], {0.01 * std::sin(i + static_cast<double>(k)), 0.01, 0}, 0.01);
      s.steps(1);
    }
    std::vector<double> bits;
    for (const BodyId crate : crates)
      bits.push_back(s.physics.state(crate)->position.local.y);
    bits.push_back(s.at(id).feet.local.x);
    bits.push_back(s.at(id).feet.local.y);
    return bits;
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace psygen::physics
