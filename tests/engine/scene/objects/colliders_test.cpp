// Solid objects of a scene: rays hit entities, step by step.
#include "engine/scene/objects/colliders.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "engine/query/world.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

models::Collider ball(float radius) {
  models::Collider collider;
  collider.shapes.emplace_back(models::Collider::Sphere{{0, 0, 0}, radius});
  return collider;
}

core::MeshData quad() {
  core::MeshData mesh;
  mesh.positions = {{-2, 1, -1}, {2, 1, -1}, {2, 1, 1}, {-2, 1, 1}};
  mesh.indices = {0, 2, 1, 0, 3, 2};
  return mesh;
}

class SolidObjects : public testing::Test {
 protected:
  void SetUp() override {
    scene_ = make_scene_of(small_settings(), [](world::World& world) { world.scatter.clear(); });
    Systems systems = scene_->systems();
    systems.step.add("before", [this](ecs::World& entities) {
      if (in_step_) in_step_(entities);
    });
    ASSERT_TRUE(colliders_.add_systems(systems));
    ASSERT_TRUE(scene_->arrange());
    query_.emplace(state().facts.world, state().facts.registry);
    query_->meet(&colliders_.objects());
    const auto ball_of_1_m = colliders_.add(ball(1));
    ASSERT_TRUE(ball_of_1_m) << ball_of_1_m.error().message;
    ball_ = *ball_of_1_m;
  }
  State& state() { return state_of(*scene_); }
  // A place high above the ground.
  static core::WorldPosition sky(double x = 0) { return {{2, 3}, {x, 4000, 10}}; }
  ecs::Entity put(const core::WorldPosition& at) {
    const auto made = state().entities.create<Transform, ObjectCollider>(1);
    made.column<Transform>()[0].position = at;
    made.column<ObjectCollider>()[0].shape = ball_;
    return made.entities[0];
  }
  Transform& transform(ecs::Entity entity) { return *state().entities.get<Transform>(entity); }
  query::Hit east_of(double x) {
    return *query_->cast({.origin = sky(x), .direction = {1, 0, 0}, .longest_m = 100});
  }
  // One step of the simulation.
  void step() { state().simulation.systems.run(); }

  std::unique_ptr<Scene> scene_;
  Colliders colliders_;
  std::optional<query::World> query_;
  ColliderId ball_;
  std::function<void(ecs::World&)> in_step_;
};

TEST_F(SolidObjects, AreHitByRaysAtTheirPlaceOfTheLastStep) {
  const ecs::Entity entity = put(sky(20));
  EXPECT_EQ(east_of(0).kind, query::HitKind::kNothing);
  step();
  const query::Hit hit = east_of(0);
  ASSERT_EQ(hit.kind, query::HitKind::kObject);
  EXPECT_EQ(entity_of(hit.object), entity);
  EXPECT_NEAR(hit.distance_m, 19, 1e-9);
  in_step_ = [&](ecs::World&) { transform(entity).position.local.x += 10; };
  step();
  EXPECT_NEAR(east_of(0).distance_m, 29, 1e-9) << "moved by a system of the same step";
  transform(entity).position.local.x = 90;
  EXPECT_NEAR(east_of(0).distance_m, 29, 1e-9) << "where it is only drawn";
}

TEST_F(SolidObjects, AreSolidAfterAnUpdateWithoutAStep) {
  put(sky(20));
  colliders_.update(scene_->facts(), scene_->entities());
  EXPECT_EQ(east_of(0).kind, query::HitKind::kObject);
}

TEST_F(SolidObjects, DestroyedInAStepAreGoneAfterIt) {
  const ecs::Entity entity = put(sky(20)), other = put(sky(40));
  step();
  in_step_ = [&](ecs::World& entities) { entities.destroy(std::span(&entity, 1)); };
  step();
  EXPECT_EQ(entity_of(east_of(0).object), other);
  in_step_ = nullptr;
  state().entities.destroy(std::span(&other, 1));
  const query::Hit stale = east_of(0);
  ASSERT_EQ(stale.kind, query::HitKind::kObject) << "until the next update";
  EXPECT_EQ(state().entities.get<Transform>(entity_of(stale.object)), nullptr);
  const ecs::Entity third = put(sky(60));
  step();
  EXPECT_EQ(entity_of(east_of(0).object), third);
}

TEST_F(SolidObjects, FollowChangesOfTheirComponent) {
  const ecs::Entity entity = put(sky(20));
  step();
  state().entities.get<ObjectCollider>(entity)->shape = *colliders_.add(ball(5));
  step();
  EXPECT_NEAR(east_of(0).distance_m, 15, 1e-9);
  transform(entity).scale = glm::vec3(2);
  step();
  EXPECT_NEAR(east_of(0).distance_m, 10, 1e-6);
  state().entities.remove<ObjectCollider>(std::span(&entity, 1));
  step();
  EXPECT_EQ(east_of(0).kind, query::HitKind::kNothing);
}

TEST_F(SolidObjects, WithACopiedComponentAreSeparateObjects) {
  const ecs::Entity first = put(sky(20)), second = put(sky(40));
  step();
  *state().entities.get<ObjectCollider>(second) = *state().entities.get<ObjectCollider>(first);
  step();
  EXPECT_EQ(entity_of(east_of(0).object), first);
  EXPECT_EQ(entity_of(east_of(30).object), second);
  EXPECT_EQ(colliders_.objects().size(), 2u);
}

TEST_F(SolidObjects, WithInvalidValuesAreCountedAndRecover) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<ecs::Entity> bad;
  for (int i = 0; i < 6; ++i)
    bad.push_back(put(sky(20)));
  const ecs::Entity good = put(sky(50));
  step();
  ASSERT_EQ(colliders_.objects().size(), 7u);
  EXPECT_EQ(colliders_.invalid(), 0u);
  transform(bad[0]).position.local.x = nan;
  transform(bad[1]).rotation = glm::quat(0, 0, 0, 0);
  transform(bad[2]).scale = glm::vec3(1e7F);
  transform(bad[3]).scale.y = static_cast<float>(nan);
  transform(bad[4]).position.block.x = -1;  // the paper's world is bounded
  state().entities.get<ObjectCollider>(bad[5])->shape = {12345};
  step();
  EXPECT_EQ(colliders_.invalid(), 6u);
  EXPECT_EQ(colliders_.objects().size(), 1u);
  EXPECT_EQ(entity_of(east_of(0).object), good);
  transform(bad[4]).position = sky(20);
  step();
  EXPECT_EQ(colliders_.invalid(), 5u);
  EXPECT_EQ(entity_of(east_of(0).object), bad[4]);
}

TEST_F(SolidObjects, InvalidCollidersAreRejectedByName) {
  const auto refused = colliders_.add(ball(-1), "barrel");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, testing::HasSubstr("barrel: part 0 of the collider"));
}

TEST_F(SolidObjects, TakeTheBoxOfTheirMeshEvenIfItIsFlat) {
  const auto mesh = state().assets.add_mesh(quad());
  ASSERT_TRUE(mesh) << mesh.error().message;
  const ecs::Entity entity = spawn(state().entities, {.mesh = *mesh}, {.position = sky(20)});
  ASSERT_TRUE(colliders_.make_solid(scene_->entities(), scene_->assets(), entity));
  ASSERT_TRUE(colliders_.make_solid(scene_->entities(), scene_->assets(), entity)) << "again";
  step();
  core::WorldPosition above = sky(21.9);
  above.local.y += 11;
  const auto hit = query_->cast({.origin = above, .longest_m = 100});
  ASSERT_EQ(hit->kind, query::HitKind::kObject);
  EXPECT_EQ(entity_of(hit->object), entity);
  EXPECT_NEAR(hit->distance_m, 10, 0.006);
  EXPECT_EQ(*colliders_.box_of(state().assets, *mesh), *colliders_.box_of(state().assets, *mesh));
  EXPECT_FALSE(colliders_.make_solid(scene_->entities(), scene_->assets(), put(sky())));
  EXPECT_FALSE(colliders_.make_solid(scene_->entities(), scene_->assets(), {}));
  EXPECT_FALSE(colliders_.box_of(state().assets, {999}));
}

}  // namespace
}  // namespace psygen::scene
