// Rays against objects of a game, among ground and models.
#include "engine/query/objects.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>
#include <random>

#include "tests/engine/query/triangles.hpp"
#include "tests/engine/query/worlds.hpp"

namespace psygen::query {
namespace {

using models::Collider;
using testing::kNan;
using testing::Loaded;

constexpr float kInf = std::numeric_limits<float>::infinity();

Collider of(Collider::Shape shape) {
  Collider collider;
  collider.shapes.push_back(std::move(shape));
  return collider;
}
Collider box(const glm::vec3& half) {
  return of(Collider::Box{-half, half});
}
Collider octahedron(float size) {
  return of(Collider::Hull{
      {{size, 0, 0}, {-size, 0, 0}, {0, size, 0}, {0, -size, 0}, {0, 0, size}, {0, 0, -size}}});
}
ObjectShape shape(Collider collider) {
  auto made = Objects::make_shape(std::move(collider));
  EXPECT_TRUE(made) << made.error().message;
  return made.value_or(nullptr);
}

struct Scene {
  Loaded loaded;
  World query;
  Objects objects;
  ObjectTag last_name = 0;

  explicit Scene(Loaded from = Loaded::shipped("paper"))
      : loaded(std::move(from)), query(loaded.world, loaded.registry), objects(loaded.world) {
    query.meet(&objects);
  }
  // A position high above all ground and models.
  core::WorldPosition sky(double x = 0, double y = 0, double z = 0) const {
    return {some_block(), {x, 5000 + y, z}};
  }
  core::BlockCoord some_block() const { return {200, 200}; }
  ObjectId put(const Collider& collider, const ObjectPose& pose) {
    const auto added = objects.add(++last_name, shape(collider), pose);
    EXPECT_TRUE(added) << added.error().message;
    return added.value_or(ObjectId());
  }
  Hit cast(const core::WorldPosition& from, const glm::dvec3& direction, double longest_m = 1000) {
    const auto hit = query.cast({.origin = from, .direction = direction, .longest_m = longest_m});
    EXPECT_TRUE(hit) << hit.error().message;
    return hit.value_or(Hit());
  }
};

TEST(Objects, AreHitByRaysWithTheirNamePointAndNormal) {
  Scene scene;
  const auto east = glm::dvec3(1, 0, 0);
  scene.put(box({1, 2, 3}), {.position = scene.sky(20)});
  const Hit hit = scene.cast(scene.sky(), east);
  EXPECT_EQ(hit.kind, HitKind::kObject);
  EXPECT_EQ(hit.object, 1u);
  EXPECT_NEAR(hit.distance_m, 19, 1e-9);
  EXPECT_NEAR(hit.position.local.x, 19, 1e-6);
  EXPECT_NEAR(glm::distance(hit.normal, glm::vec3(-1, 0, 0)), 0, 1e-6);
  EXPECT_EQ(scene.cast(scene.sky(), -east).kind, HitKind::kNothing);
  EXPECT_EQ(scene.cast(scene.sky(), east, 18.9).kind, HitKind::kNothing);
  scene.query.meet(nullptr);
  EXPECT_EQ(scene.cast(scene.sky(), east).kind, HitKind::kNothing);
}

TEST(Objects, AreScaledAlongTheirOwnAxesAndThenRotated) {
  Scene scene;
  // A box of 2 x 1 x 1 m, four times as long, turned by 90 degrees: its long side is along z.
  ObjectPose pose{.position = scene.sky(20)};
  pose.rotation = glm::angleAxis(std::numbers::pi / 2, glm::dvec3(0, 1, 0));
  pose.scale = {4, 1, -1};
  scene.put(box({1, 0.5F, 0.5F}), pose);
  EXPECT_NEAR(scene.cast(scene.sky(), {1, 0, 0}).distance_m, 19.5, 1e-6);
  EXPECT_EQ(scene.cast(scene.sky(0, 0, 3.9), {1, 0, 0}).kind, HitKind::kObject);
  EXPECT_EQ(scene.cast(scene.sky(0, 0, 4.1), {1, 0, 0}).kind, HitKind::kNothing);
  const Hit end = scene.cast(scene.sky(20, 0, -20), {0, 0, 1});
  EXPECT_NEAR(end.distance_m, 16, 1e-5);
  EXPECT_NEAR(glm::distance(end.normal, glm::vec3(0, 0, -1)), 0, 1e-6);
}

TEST(Objects, SpheresAndCapsulesAreScaledByTheLargestAxisAndHullsExactly) {
  Scene scene;
  const auto distance = [&](const Collider& collider, const glm::vec3& scale,
                            const glm::dvec3& from, const glm::dvec3& direction) {
    const ObjectId id = scene.put(collider, {.position = scene.sky(), .scale = scale});
    core::WorldPosition origin = scene.sky();
    origin.local += from;
    const double found = scene.cast(origin, direction).distance_m;
    scene.objects.remove(id);
    return found;
  };
  const Collider ball = of(Collider::Sphere{{1, 0, 0}, 0.5F});
  EXPECT_NEAR(distance(ball, {2, 3, 1}, {2, 10, 0}, {0, -1, 0}), 8.5, 1e-6);
  const Collider pill = of(Collider::Capsule{{0, -1, 0}, {0, 1, 0}, 0.5F});
  EXPECT_NEAR(distance(pill, {1, 3, 1}, {0, 10, 0}, {0, -1, 0}), 10 - 3 - 1.5, 1e-6);
  EXPECT_NEAR(distance(octahedron(1), {1, 5, 1}, {0, 10, 0}, {0, -1, 0}), 5, 1e-4);
  EXPECT_NEAR(distance(octahedron(1), {1, 5, 1}, {10, 0, 0}, {-1, 0, 0}), 9, 1e-4);
}

TEST(Objects, RaysHitTheNearestOfGroundModelsAndObjects) {
  Scene scene;
  const core::BlockCoord block = scene.some_block();
  for (const StandingSolid& s : scene.query.solids(block).solids) {
    core::WorldPosition above{block, s.foot};
    const double top = s.foot.y + double{s.solid.box().max.y};
    above.local.y = top + 20;
    const glm::dvec3 down(0, -1, 0);
    const Hit bare = scene.cast(above, down);
    ASSERT_NE(bare.kind, HitKind::kObject);
    ObjectPose pose{.position = above};
    pose.position.local.y = top + 10;
    const ObjectId id = scene.put(box({1, 1, 1}), pose);
    const Hit covered = scene.cast(above, down);
    ASSERT_EQ(covered.kind, HitKind::kObject);
    ASSERT_NEAR(covered.distance_m, 9, 1e-6);
    ASSERT_EQ(scene.query.cast({.origin = above, .objects = false})->kind, bare.kind);
    pose.position.local.y = s.foot.y - 100;  // below the ground
    ASSERT_TRUE(scene.objects.move(id, pose));
    const Hit above_it = scene.cast(above, down);
    ASSERT_EQ(above_it.kind, bare.kind);
    ASSERT_EQ(above_it.distance_m, bare.distance_m);
    ASSERT_EQ(scene.query.cast({.origin = above, .ground = false, .models = false})->kind,
              HitKind::kObject);
    scene.objects.remove(id);
  }
}

TEST(Objects, ARayThatBeginsInsideAnObjectHitsItAtItsOrigin) {
  Scene scene;
  scene.put(octahedron(3), {.position = scene.sky()});
  const Hit hit = scene.cast(scene.sky(0.1, 0.2, 0.1), {0, 1, 0});
  EXPECT_EQ(hit.kind, HitKind::kObject);
  EXPECT_EQ(hit.distance_m, 0);
  EXPECT_TRUE(hit.from_inside);
  EXPECT_EQ(hit.normal, glm::vec3(0, -1, 0));
}

TEST(Objects, RaysFindTheSameObjectsAsAListWhileTheyMove) {
  Scene scene;
  std::mt19937 random(3);
  const auto pick = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto some_pose = [&] {
    ObjectPose pose{.position = scene.sky(pick(-150, 150), pick(-20, 20), pick(-150, 150))};
    pose.rotation = glm::dquat(pick(-1, 1), pick(-1, 1), pick(-1, 1), pick(0.1, 1));
    pose.scale = glm::vec3(glm::dvec3(pick(0.5, 3), pick(0.5, 3), pick(0.5, 3)));
    return pose;
  };
  const Collider kinds[] = {box({1, 2, 0.5F}), octahedron(2), of(Collider::Sphere{{0, 1, 0}, 1}),
                            of(Collider::Capsule{{0, 0, 0}, {2, 1, 0}, 0.4F})};
  std::vector<ObjectId> ids;
  for (int i = 0; i < 300; ++i)
    ids.push_back(scene.put(kinds[i % 4], some_pose()));
  int hits = 0;
  for (int round = 0; round < 200; ++round) {
    for (int k = 0; k < 10; ++k)
      ASSERT_TRUE(scene.objects.move(ids[static_cast<std::size_t>(pick(0, 299))], some_pose()));
    const auto from = scene.sky(pick(-150, 150), pick(-20, 20), pick(-150, 150));
    const glm::dvec3 way = glm::normalize(glm::dvec3(pick(-1, 1), pick(-0.1, 0.1), pick(-1, 1)));
    // One by one: the nearest, each with no others.
    double nearest = 1000;
    for (const ObjectId id : ids) {
      Objects alone(scene.loaded.world);
      const PlacedObject& object = *scene.objects.find(id);
      ASSERT_TRUE(alone.add(1, object.shape, object.pose));
      const auto hit =
          alone.cast(core::normalised(from, scene.loaded.world.block_size_m()), way, 1000);
      if (hit) nearest = std::min(nearest, hit->hit.t);
    }
    const Hit hit = scene.cast(from, way);
    ASSERT_NEAR(hit.distance_m, nearest, 1e-9);
    hits += hit.kind == HitKind::kObject ? 1 : 0;
  }
  EXPECT_GT(hits, 20);
}

TEST(Objects, AreAsExactFarOutAsNearTheOrigin) {
  Scene scene(Loaded::shipped("endless"));
  for (const std::int32_t far : {0, 1 << 20, (1 << 30) + 7, -(1 << 30)}) {
    core::WorldPosition at{{far, far}, {3, 5000, 3}};
    scene.put(box({1, 1, 1}), {.position = at});
    at.local.x -= 100;
    const Hit hit = scene.cast(at, {1, 0, 0});
    EXPECT_EQ(hit.kind, HitKind::kObject) << far;
    EXPECT_NEAR(hit.distance_m, 99, 1e-9) << far;
  }
}

TEST(Objects, RemovedOnesAreNotHitAndTheirIdsAreStale) {
  Scene scene;
  const ObjectId first = scene.put(box({1, 1, 1}), {.position = scene.sky(20)});
  EXPECT_TRUE(scene.objects.remove(first));
  EXPECT_FALSE(scene.objects.remove(first));
  EXPECT_EQ(scene.cast(scene.sky(), {1, 0, 0}).kind, HitKind::kNothing);
  const ObjectId second = scene.put(box({1, 1, 1}), {.position = scene.sky(20)});
  EXPECT_EQ(second.slot, first.slot);
  EXPECT_EQ(scene.objects.find(first), nullptr);
  EXPECT_FALSE(scene.objects.move(first, {.position = scene.sky()}));
  EXPECT_EQ(scene.objects.find({}), nullptr);
  EXPECT_NE(scene.objects.find(second), nullptr);
}

TEST(Objects, ThatAreNotSetAgainAreRemoved) {
  Scene scene;
  const ObjectPose pose{.position = scene.sky(20)};
  const ObjectId kept = scene.put(box({1, 1, 1}), pose);
  scene.put(box({1, 1, 1}), pose);
  EXPECT_EQ(scene.objects.remove_stale(), 0u);
  ASSERT_TRUE(scene.objects.move(kept, pose));
  EXPECT_EQ(scene.objects.remove_stale(), 1u);
  EXPECT_NE(scene.objects.find(kept), nullptr);
  EXPECT_EQ(scene.objects.size(), 1u);
}

TEST(Objects, InvalidCollidersAreRejectedWithAMessageThatNamesThePart) {
  const auto refusal = [](Collider collider) {
    const auto made = Objects::make_shape(std::move(collider));
    EXPECT_FALSE(made);
    return made ? std::string() : made.error().message;
  };
  using ::testing::HasSubstr;
  EXPECT_THAT(refusal({}), HasSubstr("1 … 64 parts, not 0"));
  Collider many;
  many.shapes.resize(65, Collider::Sphere{{}, 1});
  EXPECT_THAT(refusal(many), HasSubstr("not 65"));
  Collider second = box({1, 1, 1});
  second.shapes.emplace_back(Collider::Sphere{{0, kNan, 0}, 1});
  EXPECT_THAT(refusal(second), HasSubstr("part 1 of the collider is unusable: a value is not"));
  EXPECT_THAT(refusal(box({1, kNan, 1})), HasSubstr("not finite"));
  EXPECT_THAT(refusal(box({1, kInf, 1})), HasSubstr("not finite"));
  EXPECT_THAT(refusal(box({1, 0, 1})), HasSubstr("0 m thick along y"));
  EXPECT_THAT(refusal(box({1, 1, -2})), HasSubstr("-4 m thick along z"));
  EXPECT_THAT(refusal(box({1001, 1, 1})), HasSubstr("farther than 1000 m"));
  EXPECT_THAT(refusal(of(Collider::Sphere{{}, -1})), HasSubstr("thick"));
  EXPECT_THAT(refusal(of(Collider::Sphere{{}, kNan})), HasSubstr("not finite"));
  EXPECT_THAT(refusal(of(Collider::Capsule{{0, 0, 0}, {0, 1, 0}, 0})), HasSubstr("radius 0 m"));
  EXPECT_THAT(refusal(of(Collider::Capsule{{0, 0, 0}, {0, 1, 0}, kNan})), HasSubstr("radius nan"));
  EXPECT_THAT(refusal(of(Collider::Hull{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}})),
              HasSubstr("4 … 256 points, not 3"));
  EXPECT_THAT(refusal(of(Collider::Hull{std::vector<glm::vec3>(100'000)})),
              HasSubstr("not 100000"));
  EXPECT_THAT(refusal(of(Collider::Hull{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {kNan, 0, 1}}})),
              HasSubstr("not finite"));
  EXPECT_THAT(refusal(of(Collider::Hull{{{0, 0, 0}, {1, 0, 1}, {0, 1, 0}, {1, 1, 1}}})),
              HasSubstr("one plane"));
}

TEST(Objects, InvalidPosesAreRejectedAndTheObjectStays) {
  Scene scene(Loaded::parsed(testing::kBounded));
  const ObjectPose good{.position = {{3, 2}, {0, 5000, 0}}};
  const ObjectId id = scene.put(box({1, 1, 1}), good);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<ObjectPose> bad(9, good);
  bad[0].position.local.x = nan;
  bad[1].position.local.y = std::numeric_limits<double>::infinity();
  bad[2].position.block = {100, 0};  // outside the world
  bad[3].position.local.z = -1e6;    // also
  bad[4].rotation = glm::dquat(0, 0, 0, 0);
  bad[5].rotation.x = nan;
  bad[6].scale = {1, 0, 1};
  bad[7].scale = {1, kNan, 1};
  bad[8].scale = {2000, 1, 1};
  for (std::size_t i = 0; i < bad.size(); ++i) {
    const auto moved = scene.objects.move(id, bad[i]);
    ASSERT_FALSE(moved) << i;
    EXPECT_FALSE(moved.error().message.empty());
    EXPECT_FALSE(scene.objects.add(77, shape(box({1, 1, 1})), bad[i])) << i;
  }
  EXPECT_FALSE(scene.objects.add(0, shape(box({1, 1, 1})), good)) << "without a name";
  EXPECT_FALSE(scene.objects.add(1, nullptr, good)) << "without a shape";
  EXPECT_FALSE(Objects().add(1, shape(box({1, 1, 1})), good)) << "without a world";
  EXPECT_EQ(scene.objects.size(), 1u);
  EXPECT_TRUE(scene.objects.find(id)->pose == good);
}

}  // namespace
}  // namespace psygen::query
