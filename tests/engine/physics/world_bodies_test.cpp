// The bodies of physics::World.
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "tests/engine/physics/scene.hpp"

namespace psygen::physics {
namespace {

using testing::ball;
using testing::box;
using testing::kBounded;
using testing::kNan;
using testing::Loaded;
using testing::Scene;

TEST(PhysicsBodies, FallByGravityAndComeToRestOnTheGround) {
  Scene scene(Loaded::shipped("silver_combe"));
  const auto body = scene.physics.add(
      {.shape = box(glm::vec3(0.5F)), .position = scene.above({5, 5}, 20, 20, 30)});
  ASSERT_TRUE(body);
  const double start = scene.physics.state(*body)->position.local.y;
  scene.steps(60);
  const auto falling = scene.physics.state(*body);
  EXPECT_NEAR(start - falling->position.local.y, 0.5 * 9.81, 0.2);
  EXPECT_NEAR(falling->velocity.y, -9.81, 0.1);
  scene.steps(1200);
  const auto rest = scene.physics.state(*body);
  EXPECT_LT(glm::length(rest->velocity), 0.5);
  EXPECT_NEAR(rest->position.local.y, scene.ground_m(rest->position) + 0.5, 0.5);
}

TEST(PhysicsBodies, StackOnOneAnother) {
  Scene scene(Loaded::shipped("five_species"));
  const auto table = scene.physics.add({.shape = box({5, 0.5F, 5}),
                                        .motion = Motion::kKinematic,
                                        .position = scene.above({5, 5}, 20, 20, 40)});
  ASSERT_TRUE(table);
  core::WorldPosition at = scene.physics.state(*table)->position;
  std::vector<BodyId> stack;
  for (int i = 0; i < 4; ++i) {
    at.local.y += 1.2;
    stack.push_back(*scene.physics.add({.shape = box(glm::vec3(0.5F)), .position = at}));
  }
  scene.steps(600);
  double below = scene.physics.state(*table)->position.local.y;
  for (const BodyId id : stack) {
    const double y = scene.physics.state(id)->position.local.y;
    EXPECT_NEAR(y, below + 1, 0.1);
    below = y;
    EXPECT_TRUE(scene.physics.state(id)->asleep);
  }
}

TEST(PhysicsBodies, WakeOnlyWhenTheirSupportIsRemoved) {
  Scene scene(Loaded::shipped("five_species"));
  std::vector<BodyId> tables, crates, lids;
  for (int i = 0; i < 3; ++i) {
    core::WorldPosition at = scene.above({5, 5}, 10.0 + 20 * i, 20, 40);
    tables.push_back(*scene.physics.add(
        {.shape = box({2, 0.5F, 2}), .motion = Motion::kKinematic, .position = at}));
    at.local.y += 1.01;
    crates.push_back(*scene.physics.add({.shape = box(glm::vec3(0.5F)), .position = at}));
    at.local.y += 1.01;
    lids.push_back(*scene.physics.add({.shape = box(glm::vec3(0.5F)), .position = at}));
  }
  scene.steps(600);
  const auto sleeps = [&](BodyId id) { return scene.physics.state(id)->asleep; };
  const auto height_m = [&](BodyId id) { return scene.physics.state(id)->position.local.y; };
  for (std::size_t i = 0; i < 3; ++i)
    ASSERT_TRUE(sleeps(crates[i]) && sleeps(lids[i])) << i;
  const double before_m[] = {height_m(lids[0]), height_m(lids[1]), height_m(lids[2])};

  ASSERT_TRUE(scene.physics.remove(tables[0]));
  EXPECT_FALSE(sleeps(crates[0]));
  core::WorldPosition away = scene.physics.state(tables[1])->position;
  away.local.z += 30;
  ASSERT_TRUE(scene.physics.set_pose(tables[1], away, {1, 0, 0, 0}));
  for (int i = 0; i < 60; ++i) {
    scene.steps(1);
    ASSERT_TRUE(sleeps(crates[2]) && sleeps(lids[2]));
  }
  EXPECT_LT(height_m(lids[0]), before_m[0] - 3);
  EXPECT_LT(height_m(lids[1]), before_m[1] - 3);
  // Removes a sleeping body from below another one.
  ASSERT_TRUE(scene.physics.remove(crates[2]));
  scene.steps(20);
  EXPECT_LT(height_m(lids[2]), before_m[2] - 0.3);
}

TEST(PhysicsBodies, AreStoppedByTrunks) {
  Scene scene(Loaded::shipped("paper"));
  const models::ModelIndex tree[] = {
      static_cast<models::ModelIndex>(scene.loaded.registry.find("tree"))};
  std::vector<query::NearbyModel> trees;
  ASSERT_TRUE(scene.query.models_within(scene.above({50, 50}, 30, 30, 0), 150, trees, tree));
  ASSERT_GE(trees.size(), 20U);
  int stopped = 0, thrown = 0;
  for (std::size_t i = 0; i < 20; ++i) {
    core::WorldPosition at = trees[i].position;
    at.local.y += 1;
    at.local.x -= 3;
    if (scene.ground_m(at) > at.local.y - 0.3) continue;
    const auto free = scene.query.cast({.origin = at, .direction = {1, 0, 0}, .longest_m = 2.9});
    if (!free || (free->kind == query::HitKind::kModel && free->index != trees[i].index)) continue;
    ++thrown;
    const auto body = scene.physics.add(
        {.shape = ball(0.1F), .position = at, .velocity = {60, 0, 0}, .friction = 0.1});
    ASSERT_TRUE(body);
    scene.steps(10);
    const auto state = scene.physics.state(*body);
    const double way = (state->position.block.x - trees[i].position.block.x) * 63.0 +
                       state->position.local.x - trees[i].position.local.x;
    stopped += way < 0.3 || std::abs(state->velocity.z) > 1;
    ASSERT_TRUE(scene.physics.remove(*body));
  }
  EXPECT_GT(thrown, 5);
  EXPECT_EQ(stopped, thrown);
}

TEST(PhysicsBodies, KinematicOnesPushDynamicOnes) {
  Scene scene(Loaded::shipped("five_species"));
  const core::WorldPosition at = scene.above({5, 5}, 30, 30, 50);
  const auto floor = scene.physics.add(
      {.shape = box({20, 0.5F, 20}), .motion = Motion::kKinematic, .position = at});
  core::WorldPosition on = at;
  on.local.y += 1;
  const auto crate = scene.physics.add({.shape = box(glm::vec3(0.45F)), .position = on});
  on.local.x -= 3;
  const auto plough = scene.physics.add(
      {.shape = box(glm::vec3(0.4F)), .motion = Motion::kKinematic, .position = on});
  ASSERT_TRUE(floor && crate && plough);
  scene.steps(60);
  for (int i = 0; i < 120; ++i) {
    on.local.x += 0.05;
    ASSERT_TRUE(scene.physics.set_pose(*plough, on, {1, 0, 0, 0}));
    scene.steps(1);
  }
  EXPECT_GT(scene.physics.state(*crate)->position.local.x, at.local.x + 2.5);
}

TEST(PhysicsBodies, ArePushedByImpulsesAndTeleported) {
  Scene scene(Loaded::shipped("endless"));
  const auto body = scene.physics.add(
      {.shape = ball(0.5F), .position = scene.above({0, 0}, 5, 5, 100), .mass_kg = 2});
  ASSERT_TRUE(body);
  ASSERT_TRUE(scene.physics.push(*body, {20, 0, 0}));
  EXPECT_NEAR(scene.physics.state(*body)->velocity.x, 10, 1e-9);
  const core::BlockCoord far{1 << 30, -(1 << 30)};
  ASSERT_TRUE(scene.physics.set_pose(*body, scene.above(far, 10.125, 20.25, 50), {1, 0, 0, 0}));
  const auto there = scene.physics.state(*body);
  EXPECT_EQ(there->position.block, far);
  EXPECT_EQ(there->position.local.x, 10.125);
  scene.steps(600);
  const auto rest = scene.physics.state(*body);
  EXPECT_GE(rest->position.local.y, scene.ground_m(rest->position));
}

TEST(PhysicsBodies, RejectIllegalValues) {
  Scene scene(Loaded::parsed(kBounded), {.max_bodies = 2});
  const BodySettings sound{.shape = ball(0.5F), .position = scene.above({1, 1}, 5, 5, 3)};
  const auto refused = [&](auto&& change) {
    BodySettings s = sound;
    change(s);
    const auto body = scene.physics.add(s);
    return !body && body.error().code == core::ErrorCode::kInvalidArgument;
  };
  EXPECT_TRUE(refused([](BodySettings& s) { s.shape = {}; }));
  EXPECT_TRUE(refused([](BodySettings& s) { s.position.local.y = kNan; }));
  EXPECT_TRUE(refused([](BodySettings& s) { s.position.block = {99, 1}; }));
  EXPECT_TRUE(refused([](BodySettings& s) { s.rotation = {0, 0, 0, 0}; }));
  EXPECT_TRUE(refused([](BodySettings& s) { s.rotation = {kNan, 0, 0, 1}; }));
  EXPECT_TRUE(refused([](BodySettings& s) { s.velocity.x = 1e9; }));
  EXPECT_TRUE(refused([](BodySettings& s) { s.spin.z = kNan; }));
  EXPECT_TRUE(refused([](BodySettings& s) { s.mass_kg = 0; }));
  EXPECT_TRUE(refused([](BodySettings& s) { s.mass_kg = kNan; }));
  EXPECT_TRUE(refused([](BodySettings& s) { s.friction = -1; }));
  EXPECT_TRUE(refused([](BodySettings& s) { s.restitution = 2; }));
  const auto body = scene.physics.add(sound);
  ASSERT_TRUE(body && scene.physics.add(sound));
  const auto third = scene.physics.add(sound);
  ASSERT_FALSE(third);
  EXPECT_EQ(third.error().code, core::ErrorCode::kOverBudget);
  EXPECT_FALSE(scene.physics.set_velocity(*body, {kNan, 0, 0}, {}));
  EXPECT_FALSE(scene.physics.push(*body, {1e30, 0, 0}));
  EXPECT_FALSE(scene.physics.set_pose(*body, {{0, 0}, {kNan, 0, 0}}, {1, 0, 0, 0}));
  ASSERT_TRUE(scene.physics.remove(*body));
  EXPECT_FALSE(scene.physics.remove(*body));
  EXPECT_FALSE(scene.physics.state(*body));
  EXPECT_FALSE(scene.physics.push(*body, {1, 0, 0}));
  scene.steps(5);
}

}  // namespace
}  // namespace psygen::physics
