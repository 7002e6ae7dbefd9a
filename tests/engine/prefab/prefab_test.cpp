// Instances of glTF files on the null device: their hierarchy, their animations, and removal.
#include "engine/prefab/prefab.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "ecs/snapshot.hpp"
#include "engine/gltf/read_file.hpp"
#include "engine/scene/objects/effects.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::prefab {
namespace {

using scene::Object;
using scene::Transform;

gltf::Model two_nodes() {
  gltf::Model model;
  model.name = "arm.glb";
  core::MeshData mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.indices = {0, 1, 2};
  model.meshes.resize(1);
  model.meshes[0].primitives = {{mesh, gltf::kNone}, {mesh, 0}};
  model.materials.resize(1);
  model.nodes = {{"arm", gltf::kNone, 0, {}}, {"hand", 0, 0, {}}};
  model.nodes[1].rest.translation = {2, 0, 0};
  gltf::Channel channel;  // moves node 0
  channel.times_s = {0, 2};
  channel.values = {{0, 0, 0, 0}, {0, 4, 0, 0}};
  model.animations = {{"lift", 2, {channel}}};
  return model;
}

class Prefabs : public testing::Test {
 protected:
  void SetUp() override {
    scene_ = scene::make_scene_of(scene::small_settings(),
                                  [](world::World& world) { world.scatter.clear(); });
    scene::Systems systems = scene_->systems();
    ASSERT_TRUE(library_.add_systems(systems));
    scene_->settle(pose_);
    const auto added = library_.add(scene_->assets(), two_nodes());
    ASSERT_TRUE(added) << added.error().message;
    arm_ = *added;
    where_.position = pose_.position;
    where_.position.local += glm::dvec3(0, -4, -20);
    root_ = library_.spawn(scene_->entities(), arm_, where_);
  }
  void tick(int count = 1) {
    for (int i = 0; i < count; ++i)
      scene::tick_at(*scene_, pose_);
  }
  glm::dvec3 place_of(const char* node) {
    const ecs::Entity entity = library_.node_of(scene_->entities(), root_, node);
    return scene_->entities().get<Transform>(entity)->position.local - where_.position.local;
  }

  core::CameraPose pose_ = scene::pose_at(0, 0);
  Library library_;  // outlives the scene
  std::unique_ptr<scene::Scene> scene_;
  PrefabId arm_;
  Transform where_;
  ecs::Entity root_;
};

TEST_F(Prefabs, AreDrawnAndFollowTheirRoot) {
  tick(3);
  EXPECT_EQ(scene_->statistics().objects.drawn, 4u) << "two nodes with two materials each";
  EXPECT_EQ(place_of("hand"), glm::dvec3(2, 0, 0));
  Transform& root = *scene_->entities().get<Transform>(root_);
  root.rotation = glm::angleAxis(1.5707964F, glm::vec3(0, 0, 1));
  root.scale = {3, 1, 1};
  tick();
  EXPECT_LT(glm::length(place_of("hand") - glm::dvec3(0, 6, 0)), 1e-5);
  const ecs::Entity hand = library_.node_of(scene_->entities(), root_, "hand");
  const Transform& turned = *scene_->entities().get<Transform>(hand);
  EXPECT_LT(glm::length(turned.scale - glm::vec3(3, 1, 1)), 1e-5F);
  EXPECT_LT(glm::length(turned.rotation * glm::vec3(1, 0, 0) - glm::vec3(0, 1, 0)), 1e-5F);
}

TEST_F(Prefabs, MirrorByNegativeScales) {
  scene_->entities().get<Transform>(root_)->scale = {1, -2, 1};
  tick();
  const ecs::Entity hand = library_.node_of(scene_->entities(), root_, "hand");
  const Transform& mirrored = *scene_->entities().get<Transform>(hand);
  const auto place = [&](glm::vec3 p) { return mirrored.rotation * (mirrored.scale * p); };
  EXPECT_LT(glm::length(place({1, 2, 3}) - glm::vec3(1, -4, 3)), 1e-5F);
}

TEST_F(Prefabs, PlayAnimationsByTheStepsOfTheSimulation) {
  Instance& instance = *scene_->entities().get<Instance>(root_);
  tick();
  ASSERT_TRUE(library_.play(instance, "lift", scene_->step(), {.speed = 2}));
  const std::uint64_t from = scene_->step().index;
  tick(31);
  const scene::FixedStep& step = scene_->step();
  const double passed_s = (static_cast<double>(step.index - from) - 1 + step.share) * step.step_s;
  ASSERT_GT(passed_s, 0.4);
  EXPECT_NEAR(place_of("arm").y, 2 * 2 * passed_s, 1e-5) << "2 m a second, twice as fast";
  EXPECT_NEAR(place_of("hand").y, 2 * 2 * passed_s, 1e-5);
  const double before = place_of("arm").y;
  tick(60);
  EXPECT_NEAR(place_of("arm").y, before, 1e-4) << "a second later it has looped once";
  ASSERT_TRUE(library_.play(instance, "lift", step, {.from_s = 1.5, .loops = false}));
  tick(120);
  EXPECT_NEAR(place_of("arm").y, 4, 1e-6) << "it stays at its end";
}

TEST_F(Prefabs, ListTheirAnimationsInErrors) {
  const auto played = library_.play(*scene_->entities().get<Instance>(root_), "sing", {});
  ASSERT_FALSE(played);
  EXPECT_EQ(played.error().message, "arm.glb has no animation \"sing\"; its animations are lift");
}

TEST_F(Prefabs, DisappearWithTheirRootAndMayLoseSingleParts) {
  tick(3);
  const ecs::Entity arm = library_.node_of(scene_->entities(), root_, "arm");
  scene_->entities().destroy(std::span(&arm, 1));
  EXPECT_EQ(library_.node_of(scene_->entities(), root_, "arm"), ecs::kNullEntity);
  ASSERT_TRUE(library_.play(*scene_->entities().get<Instance>(root_), "lift", {}));
  tick(3);
  EXPECT_EQ(scene_->statistics().objects.drawn, 3u) << "attached entities keep their positions";
  scene_->entities().destroy_with_children(std::span(&root_, 1));
  EXPECT_EQ(scene_->entities().count<Attached>(), 0u);
  tick();
  EXPECT_EQ(scene_->statistics().objects.drawn, 0u);
}

TEST_F(Prefabs, AttachToEachOtherInAnyOrderAndInCycles) {
  const auto made = scene_->entities().create<Transform, Attached>(3);
  const std::vector<ecs::Entity> own(made.entities.begin(), made.entities.end());
  for (std::size_t i = 0; i < 3; ++i)
    made.column<Attached>()[i] = {.parent = i == 2 ? root_ : own[i + 1],
                                  .pose = {.translation = {1, 0, 0}}};
  tick();
  const auto x = [&](std::size_t i) {
    return scene_->entities().get<Transform>(own[i])->position.local.x - where_.position.local.x;
  };
  EXPECT_EQ(x(0), 3);
  EXPECT_EQ(x(2), 1);
  scene_->entities().get<Attached>(own[2])->parent = own[0];
  tick(3);
}

TEST_F(Prefabs, SplitMeshesThatAreTooLarge) {
  gltf::Model model = two_nodes();
  core::MeshData& mesh = model.meshes[0].primitives[0].mesh;
  mesh = {};
  for (std::uint32_t i = 0; i < 70'000; ++i) {
    const auto at = static_cast<float>(i);
    mesh.positions.insert(mesh.positions.end(),
                          {{at * 1e-3F, 0, 0}, {at * 1e-3F, 1, 0}, {at * 1e-3F, 0, 1}});
    mesh.indices.insert(mesh.indices.end(), {3 * i, 3 * i + 1, 3 * i + 2});
  }
  const std::size_t before = scene_->assets().mesh_count();
  const auto added = library_.add(scene_->assets(), model);
  ASSERT_TRUE(added) << added.error().message;
  EXPECT_EQ(scene_->assets().mesh_count() - before, 5u) << "four parts, and the second material";
  EXPECT_EQ(library_[*added].parts.size(), 10u);
}

TEST_F(Prefabs, LeaveNoMeshesIfTheyCannotBeAdded) {
  gltf::Model model = two_nodes();
  model.meshes[0].primitives[1].mesh.indices = {0, 1, 7};
  const std::size_t before = scene_->assets().mesh_count();
  EXPECT_FALSE(library_.add(scene_->assets(), model));
  EXPECT_EQ(scene_->assets().mesh_count(), before);
}

TEST_F(Prefabs, WarnOfNodesThatTheirParentsShear) {
  const auto warning_of = [&](const gltf::Model& model) {
    testing::internal::CaptureStderr();
    EXPECT_TRUE(library_.add(scene_->assets(), model));
    return testing::internal::GetCapturedStderr();
  };
  gltf::Model model = two_nodes();
  model.nodes[0].rest.scale = {1, 3, 1};
  EXPECT_EQ(warning_of(model), "") << "a scale alone shears nothing";
  model.nodes[1].rest.rotation = glm::angleAxis(0.5F, glm::vec3(0, 1, 0));
  EXPECT_EQ(warning_of(model), "") << "nor does a turn about the axis of the scale";
  model.nodes[1].rest.rotation = glm::angleAxis(0.5F, glm::vec3(0, 0, 1));
  EXPECT_THAT(warning_of(model), testing::HasSubstr("arm.glb: node 1 \"hand\" is turned below"));
  model.nodes[0].rest.scale = {3, 3, 3};
  EXPECT_EQ(warning_of(model), "") << "nor does an equal scale";
  model.nodes[0].rest.scale = {3, 1, 1};
  model.nodes[1].rest.rotation = glm::quat(1, 0, 0, 0);
  gltf::Channel& channel = model.animations[0].channels[0];
  channel.node = 1;
  channel.property = gltf::Property::kRotation;
  channel.values = {{0, 0, 0, 1}, {0, 0, 0.6F, 0.8F}};
  EXPECT_THAT(warning_of(model), testing::HasSubstr("node 1 \"hand\""));
}

// A save contains complete instances: positions, animations and attachments.
TEST(PrefabSnapshots, ContainObjectsAndInstancesWithTheirParts) {
  ecs::World world;
  scene::spawn(world, {}, {});  // so that handles differ
  Transform place;
  place.position.block = {3, -7};
  place.position.local = {1.5, 40.25, 9};
  place.rotation = glm::quat(0.6F, 0, 0.8F, 0);
  place.scale = {1, 2, 0.5F};
  const auto root = world.create<Transform, Instance, ecs::Children>(1);
  root.column<Transform>()[0] = place;
  root.column<Instance>()[0] = {
      .prefab = {4}, .animation = 1, .speed = -2, .loops = false, .from_s = 0.75};
  const auto part = world.create<Transform, Object, Attached>(1);
  part.column<Object>()[0] = {.mesh = {9}, .material = 3, .visible = false};
  part.column<Attached>()[0] = {
      root.entities[0], {{1, 2, 3}, glm::quat(0, 1, 0, 0), {4, 5, 6}}, {}};
  world.set_children(root.entities[0], part.entities);
  const auto light = world.create<Transform, scene::PointLight>(1);
  light.column<scene::PointLight>()[0] = {
      .colour = {1, 0.5F, 0.25F}, .intensity = 7, .range_m = 33};

  const auto bytes = ecs::save_snapshot(world);
  ecs::World again;
  again.declare<Transform, Object, Attached, Instance, ecs::Children, scene::PointLight>();
  ASSERT_TRUE(ecs::load_snapshot(bytes, again));
  int seen = 0;
  again.each<const Instance, const Transform, const ecs::Children>(
      [&](std::span<const ecs::Entity> rows, std::span<const Instance> instances,
          std::span<const Transform> places, std::span<const ecs::Children> lists) {
        ++seen;
        EXPECT_EQ(instances[0].prefab, PrefabId{4});
        EXPECT_EQ(instances[0].animation, 1U);
        EXPECT_EQ(instances[0].speed, -2);
        EXPECT_FALSE(instances[0].loops);
        EXPECT_EQ(instances[0].from_s, 0.75);
        EXPECT_EQ(places[0].position.block, place.position.block);
        EXPECT_EQ(places[0].position.local, place.position.local);
        EXPECT_EQ(places[0].rotation, place.rotation);
        EXPECT_EQ(places[0].scale, place.scale);
        const auto children = again.children(lists[0]);
        ASSERT_EQ(children.size(), 1U);
        const auto* attached = again.get<Attached>(children[0]);
        ASSERT_NE(attached, nullptr);
        EXPECT_EQ(attached->parent, rows[0]);
        EXPECT_EQ(attached->pose.translation, glm::vec3(1, 2, 3));
        EXPECT_EQ(attached->pose.rotation, glm::quat(0, 1, 0, 0));
        EXPECT_EQ(attached->pose.scale, glm::vec3(4, 5, 6));
        const auto* object = again.get<Object>(children[0]);
        ASSERT_NE(object, nullptr);
        EXPECT_EQ(object->mesh, scene::MeshId{9});
        EXPECT_EQ(object->material, 3U);
        EXPECT_FALSE(object->visible);
      });
  EXPECT_EQ(seen, 1);
  again.each<const scene::PointLight>(
      [&](std::span<const ecs::Entity>, std::span<const scene::PointLight> lights) {
        ++seen;
        EXPECT_EQ(lights[0].colour, glm::vec3(1, 0.5F, 0.25F));
        EXPECT_EQ(lights[0].intensity, 7);
        EXPECT_EQ(lights[0].range_m, 33);
      });
  EXPECT_EQ(seen, 2);
}

}  // namespace
}  // namespace psygen::prefab
