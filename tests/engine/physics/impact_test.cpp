#include "engine/physics/impact.hpp"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "engine/query/objects.hpp"
#include "engine/world/edits/edits.hpp"
#include "tests/engine/physics/scene.hpp"

namespace psygen::physics {
namespace {

using models::Collider;
using testing::ball;
using testing::box;
using testing::kStep;
using testing::Loaded;
using testing::Scene;

Collider parts(std::vector<Collider::Shape> shapes) {
  Collider c;
  c.shapes = std::move(shapes);
  return c;
}

struct Missile {
  const char* name;
  Collider shape;
  std::vector<glm::dvec3> middles;  // of its parts
};

std::vector<Missile> missiles() {
  Collider::Hull blade;
  for (const float x : {-0.4F, 0.4F})
    for (const glm::vec2 at : {glm::vec2(-0.1F, 0), {0.1F, 0}, {0, 0.05F}})
      blade.points.emplace_back(x, at.x, at.y);
  return {
      {"ball", ball(0.03F), {{0, 0, 0}}},
      {"ball off its centre", parts({Collider::Sphere{{0, 0.02F, 0}, 0.03F}}), {{0, 0.02, 0}}},
      {"ball far from its centre", parts({Collider::Sphere{{-0.6F, 0, 0}, 0.05F}}), {{-0.6, 0, 0}}},
      {"spear", parts({Collider::Capsule{{-0.4F, 0, 0}, {0.4F, 0, 0}, 0.03F}}), {{0, 0, 0}}},
      {"stick", box({0.3F, 0.01F, 0.01F}), {{0, 0, 0}}},
      {"blade", parts({blade}), {{0, 0, 0.0167}}},
      {"axe",
       parts({Collider::Capsule{{-0.3F, 0, 0}, {0.3F, 0, 0}, 0.02F},
              Collider::Box{{0.2F, -0.1F, -0.02F}, {0.35F, 0.1F, 0.02F}}}),
       {{0, 0, 0}, {0.275, 0, 0}}},
      {"dumb-bell",
       parts({Collider::Sphere{{-0.4F, 0, 0}, 0.08F}, Collider::Sphere{{0.4F, 0, 0}, 0.08F}}),
       {{-0.4, 0, 0}, {0.4, 0, 0}}}};
}

// A hangar of even ground and the objects of a game.
struct Hall {
  Scene scene;
  query::Objects objects;

  explicit Hall(const Settings& settings = {.gravity = 0})
      : scene(Loaded::parsed(R"(format = 1
[world]
name = "even"
seed = 3
blocks = [0, 0]
[terrain]
relief_m = 200
feature_m = 500
)"),
              settings),
        objects(scene.loaded.world) {
    world::Edits edits;
    EXPECT_TRUE(edits.flatten(scene.loaded.world, {{0, 0}, {31, 0, 31}}, 300, 30));
    world::set_edits(scene.loaded.world, edits.layer());
    scene.query.meet(&objects);
  }
  void add(std::uint32_t number, const Collider& shape, const glm::dvec3& at) {
    ASSERT_TRUE(
        objects.add(number, *query::Objects::make_shape(shape), {.position = {{0, 0}, at}}));
  }
  double size_m() const { return scene.loaded.world.block_size_m(); }
  // A point of a body, in metres from the corner of block (0, 0).
  glm::dvec3 point(BodyId id, const glm::dvec3& in_body) {
    const BodyState s = *scene.physics.state(id);
    return core::offset_m(s.position.block, {{0, 0}}, size_m()) + s.position.local +
           s.rotation * in_body;
  }
};

TEST(Impacts, BodiesOfAnyShapeSpeedAndSpinStopAtThinWalls) {
  Hall hall;
  hall.add(1, box({0.01F, 12, 12}), {40, 45, 20});
  core::RandomStream random(7, 0, 0, 0, core::Purpose::kPosition);
  for (const Missile& missile : missiles())
    for (const double speed : {10.0, 40.0, 120.0, 600.0})
      for (int i = 0; i < 24; ++i) {
        const auto any = [&] { return random.next_real(-1, 1); };
        const glm::dquat turn = i % 4 == 0 ? glm::dquat(1, 0, 0, 0)
                                           : glm::normalize(glm::dquat(any(), any(), any(), any()));
        const double spin = i % 3 * 40;
        const BodyId id =
            *hall.scene.physics.add({.shape = missile.shape,
                                     .position = {{0, 0}, {38.5 - speed * kStep * i / 24, 45, 20}},
                                     .rotation = turn,
                                     .velocity = {speed, 0, 0},
                                     .spin = {spin * any(), spin * any(), spin * any()}});
        for (int step = 0; step < 40; ++step) {
          hall.scene.steps(1);
          for (const glm::dvec3& middle : missile.middles)
            ASSERT_LT(hall.point(id, middle).x, 40) << missile.name << speed << " m/s, " << i;
        }
        ASSERT_TRUE(hall.scene.physics.remove(id));
      }
}

TEST(Impacts, LongBodiesThatSpinStopAtPosts) {
  Hall hall;
  hall.add(1, box({0.02F, 5, 0.02F}), {40, 45, 20});
  const Collider bar = box({1, 0.02F, 0.02F});
  for (int i = 0; i < 20; ++i) {
    // The post is 0.7 m from the middle of the bar, which turns towards it by up to 45 degrees a
    // step.
    const double away = glm::radians(20.0 + 2 * i);
    const BodyId id =
        *hall.scene.physics.add({.shape = bar,
                                 .position = {{0, 0}, {39.3, 45, 20}},
                                 .rotation = glm::angleAxis(away, glm::dvec3(0, 1, 0)),
                                 .spin = {0, -44, 0},
                                 .mass_kg = 50});
    for (int step = 0; step < 8; ++step) {
      hall.scene.steps(1);
      const glm::dvec3 middle = hall.point(id, {});
      const glm::dvec3 post = glm::inverse(hall.scene.physics.state(id)->rotation) *
                              (glm::dvec3(40, middle.y, 20) - middle);
      EXPECT_TRUE(post.z > 0 || std::abs(post.x) > 0.99) << i << ", " << step;
    }
    EXPECT_GT(hall.scene.physics.state(id)->spin.y, -40) << i;
    ASSERT_TRUE(hall.scene.physics.remove(id));
  }
}

TEST(Impacts, BodiesThatFlyAtEachOtherMeet) {
  Hall hall;
  for (int i = 0; i < 20; ++i) {
    const auto thrown = [&](double x, double speed) {
      return *hall.scene.physics.add(
          {.shape = ball(0.03F), .position = {{0, 0}, {x, 45, 20}}, .velocity = {speed, 0, 0}});
    };
    const BodyId a = thrown(30 + 0.07 * i, 80), b = thrown(38, -60);
    hall.scene.steps(20);
    EXPECT_LT(hall.point(a, {}).x, hall.point(b, {}).x) << i;
    EXPECT_NEAR(hall.scene.physics.state(a)->velocity.x + hall.scene.physics.state(b)->velocity.x,
                20, 0.1)
        << i;
    ASSERT_TRUE(hall.scene.physics.remove(a) && hall.scene.physics.remove(b));
  }
}

TEST(Impacts, FastBodiesSlideAlongFloorsAndWalls) {
  Hall hall(Settings{});
  hall.add(1, box({400, 1, 20}), {430, 360, 20});
  hall.add(2, box({400, 4, 1}), {430, 363, 14.7});
  double z = 16.25;
  for (const Collider& shape : {ball(0.3F), box({0.4F, 0.3F, 0.2F})})
    for (const double speed : {20.0, 60.0}) {
      const BodyId id = *hall.scene.physics.add({.shape = shape,
                                                 .position = {{0, 0}, {40, 361.305, z}},
                                                 .velocity = {speed, 0, 0},
                                                 .friction = 0});
      hall.scene.steps(300);
      EXPECT_NEAR(hall.point(id, {}).x, 40 + 5 * speed, 0.05) << speed;
      EXPECT_NEAR(hall.point(id, {}).y, 361.3, 0.01) << speed;
      z += 1.5;
    }
  // Into the wall at an angle of 6 degrees, and then along it.
  const BodyId id = *hall.scene.physics.add({.shape = ball(0.2F),
                                             .position = {{0, 0}, {40, 361.205, 17}},
                                             .velocity = {50, 0, -5},
                                             .friction = 0});
  hall.scene.steps(300);
  EXPECT_GT(hall.point(id, {}).x, 40 + 5 * 50 - 1.5);
  EXPECT_GT(hall.point(id, {}).z, 15.85);
}

TEST(Impacts, NoPartStaysBelowTheGround) {
  Hall hall(Settings{});
  for (const Missile& missile : missiles())
    for (const double speed : {20.0, 120.0, 600.0}) {
      const BodyId id = *hall.scene.physics.add({.shape = missile.shape,
                                                 .position = {{0, 0}, {20, 33, 20}},
                                                 .rotation = glm::dquat(0.8, 0.1, 0.2, 0.5),
                                                 .velocity = {0.2 * speed, -speed, 0}});
      for (int step = 0; step < 90; ++step) {
        hall.scene.steps(1);
        for (const glm::dvec3& middle : missile.middles)
          ASSERT_GE(hall.point(id, middle).y, hall.scene.ground_m({{0, 0}, {20, 0, 20}}) - 1e-6)
              << missile.name << speed << ", " << step;
      }
      ASSERT_TRUE(hall.scene.physics.remove(id));
    }
}

}  // namespace
}  // namespace psygen::physics
