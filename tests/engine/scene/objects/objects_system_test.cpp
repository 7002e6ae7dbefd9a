// Objects of a game on the null device: their draws, and the memory of their meshes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "engine/models/model_type.hpp"
#include "tests/engine/scene/gate.hpp"

namespace psygen::scene {
namespace {

core::MeshData box_mesh(std::uint32_t cells = 1) {
  core::MeshData mesh;
  const std::uint32_t side = cells + 1;
  for (std::uint32_t z = 0; z < side; ++z) {
    for (std::uint32_t x = 0; x < side; ++x) {
      mesh.positions.push_back({2.0F * static_cast<float>(x) / static_cast<float>(cells) - 1,
                                (x + z) % 2 == 0 ? 0.0F : 1.0F,
                                2.0F * static_cast<float>(z) / static_cast<float>(cells) - 1});
      if (x == 0 || z == 0) continue;
      const std::uint32_t here = z * side + x;
      mesh.indices.insert(mesh.indices.end(),
                          {here, here - side, here - side - 1, here, here - side - 1, here - 1});
    }
  }
  return mesh;
}

class Objects : public testing::Test {
 protected:
  void SetUp() override { open(small_settings()); }
  void open(const SceneSettings& settings) {
    scene_ = make_scene_of(settings, [](world::World& world) { world.scatter.clear(); });
    scene_->settle(pose_);
    const auto mesh = state().assets.add_mesh(box_mesh());
    ASSERT_TRUE(mesh) << mesh.error().message;
    mesh_ = *mesh;
  }
  State& state() { return state_of(*scene_); }
  const std::vector<render::ObjectDraw>& drawn() { return state().object_draws.objects; }
  void tick(int count = 1) {
    for (int i = 0; i < count; ++i)
      tick_at(*scene_, pose_);
  }
  // `ahead_m` of the camera, which is high above the ground, and `aside_m`.
  Transform ahead(double ahead_m, double aside_m = 0) const {
    Transform transform;
    transform.position = pose_.position;
    transform.position.local += glm::dvec3(aside_m, -0.2 * ahead_m, -ahead_m);
    return transform;
  }
  ecs::Entity put(const Transform& transform) {
    return spawn(state().entities, {.mesh = mesh_}, transform);
  }

  core::CameraPose pose_ = pose_at(0, 0);
  std::unique_ptr<Scene> scene_;
  MeshId mesh_;
};

TEST_F(Objects, MeshesBeyondTheBudgetOfObjectsAreRefused) {
  SceneSettings settings = small_settings();
  settings.object_budget_bytes = 600;  // a box_mesh() has 4 vertices and 6 indices
  open(settings);
  Assets& assets = state().assets;
  std::vector<MeshId> meshes{mesh_};
  core::Result<MeshId> mesh = assets.add_mesh(box_mesh(), "door");
  for (; mesh && meshes.size() < 100; mesh = assets.add_mesh(box_mesh(), "door"))
    meshes.push_back(*mesh);
  ASSERT_FALSE(mesh);
  EXPECT_EQ(mesh.error().code, core::ErrorCode::kOverBudget);
  EXPECT_THAT(mesh.error().message,
              testing::MatchesRegex("door: with it, the meshes of objects need at least [0-9]+ "
                                    "bytes; SceneSettings::object_budget_bytes allows 600"));
  EXPECT_EQ(meshes.size(), 600 / (4 * sizeof(core::ObjectVertex) + 6 * sizeof(std::uint16_t)));
  assets.remove_mesh(meshes.back());
  EXPECT_TRUE(assets.add_mesh(box_mesh(), "door"));
  EXPECT_FALSE(assets.add_mesh(box_mesh(), "door"));
}

TEST_F(Objects, AreDrawnAtTheirPlaceUntilTheyAreDestroyed) {
  Transform transform = ahead(20);
  transform.rotation = glm::angleAxis(0.5F, glm::vec3(0, 1, 0));
  transform.scale = {1, 2, 3};
  const ecs::Entity entity = put(transform);
  tick(30);
  ASSERT_EQ(drawn().size(), 1u);
  const render::ObjectDraw& draw = drawn()[0];
  EXPECT_NEAR(draw.origin.z, -20, 1e-3);
  EXPECT_NEAR(draw.origin.y, -4, 1e-3);
  EXPECT_EQ(draw.scale, glm::vec3(1, 2, 3));
  EXPECT_FLOAT_EQ(draw.rotation[1], transform.rotation.y);
  EXPECT_EQ(draw.fade, 1.0F);
  EXPECT_EQ(draw.range.layout, core::VertexLayout::kObject);
  EXPECT_EQ(scene_->statistics().objects.drawn, 1u);
  state().entities.destroy(std::span(&entity, 1));
  tick();
  EXPECT_TRUE(drawn().empty());
}

TEST_F(Objects, FollowTheirTransformFromBlockToBlock) {
  const ecs::Entity entity = put(ahead(20));
  tick(5);
  Transform& transform = *state().entities.get<Transform>(entity);
  const double block_m = state().facts.world.block_size_m();
  transform.position.local.x += block_m;  // not normalised
  tick();
  ASSERT_EQ(drawn().size(), 0u) << "a block to the side at 20 m is out of view";
  transform.position = core::normalised(transform.position, block_m);
  EXPECT_EQ(transform.position.block.x, 1);
  transform.position.local.x -= block_m - 4;
  tick();
  ASSERT_EQ(drawn().size(), 1u);
  EXPECT_NEAR(drawn()[0].origin.x, 4, 1e-3);
}

TEST_F(Objects, FadeInWhenTheyAppearAndOutWhenTheyAreHidden) {
  const ecs::Entity entity = put(ahead(20));
  std::vector<float> shares;
  for (int i = 0; i < 20; ++i) {
    tick();
    if (!drawn().empty()) shares.push_back(drawn()[0].fade);
  }
  ASSERT_GT(shares.size(), 14u);
  EXPECT_LT(shares.front(), 0.2F);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_EQ(shares.back(), 1.0F);
  state().entities.get<Object>(entity)->visible = false;
  tick();
  ASSERT_EQ(drawn().size(), 1u);
  EXPECT_LT(drawn()[0].fade, 0.0F);
  tick(20);
  EXPECT_TRUE(drawn().empty());
}

TEST_F(Objects, EnteringFromTheSideAppearAtOnce) {
  put(ahead(20));
  tick(20);
  pose_.yaw = 3;
  tick(5);
  EXPECT_TRUE(drawn().empty());
  pose_.yaw = 0;
  tick();
  ASSERT_EQ(drawn().size(), 1u);
  EXPECT_EQ(drawn()[0].fade, 1.0F);
}

TEST_F(Objects, PresentWhileTheCacheWasFilledAreCompleteInTheFirstFrame) {
  put(ahead(20));
  scene_->settle(pose_);
  tick();
  ASSERT_EQ(drawn().size(), 1u);
  EXPECT_EQ(drawn()[0].fade, 1.0F);
}

TEST_F(Objects, FadeAtTheViewDistance) {
  const double end_m = state().settings.view_distance_m;
  const ecs::Entity entity = put(ahead(20));
  tick(20);
  Transform& transform = *state().entities.get<Transform>(entity);
  transform = ahead(end_m + 20);
  tick(2);
  ASSERT_EQ(drawn().size(), 1u);
  EXPECT_LT(drawn()[0].fade, 0.0F) << "goes";
  tick(20);
  EXPECT_TRUE(drawn().empty());
  transform = ahead(end_m - 20);
  tick(3);
  ASSERT_EQ(drawn().size(), 1u);
  EXPECT_GT(drawn()[0].fade, 0.0F);
  EXPECT_LT(drawn()[0].fade, 1.0F) << "comes";
}

TEST_F(Objects, WithAMeshOfFewerLevelsRequestOnlyThose) {
  const models::Registry registry = models::make_standard_registry();
  const auto& tree = registry[static_cast<models::ModelIndex>(registry.find("tree"))];
  const auto mesh = state().assets.add_model("tree", models::default_parameters(tree));
  ASSERT_TRUE(mesh) << mesh.error().message;
  const ecs::Entity entity = spawn(state().entities, {.mesh = *mesh}, ahead(110));
  tick(60);
  Object& object = *state().entities.get<Object>(entity);
  ASSERT_GT(object.state.level, 0);
  object.mesh = mesh_;
  object.visible = false;
  tick();
  EXPECT_LE(object.state.level, 0);
  for (const auto& [index, level] : state().assets.used)
    EXPECT_LT(level, state().assets.mesh({index}).level_count);
  object.visible = true;
  tick(20);
  ASSERT_EQ(drawn().size(), 1u);
  EXPECT_EQ(drawn()[0].range.index_count, 6u);
  EXPECT_EQ(scene_->statistics().meshes.failed, 0u);
}

TEST_F(Objects, WithInvalidTransformsAreCountedAndNotDrawn) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<Transform> bad(6, ahead(20));
  bad[0].position.local.x = nan;
  bad[1].position.local.y = std::numeric_limits<double>::infinity();
  bad[2].rotation = glm::quat(0, 0, 0, 0);
  bad[3].rotation.x = static_cast<float>(nan);
  bad[4].scale.z = 0;
  bad[5].scale.y = 1e20F;
  for (const Transform& transform : bad)
    put(transform);
  put(ahead(20));
  tick(10);
  EXPECT_EQ(drawn().size(), 1u);
  EXPECT_EQ(scene_->statistics().objects.invalid, 6u);
}

TEST_F(Objects, WithoutAMeshAreNotDrawn) {
  spawn(state().entities, {}, ahead(20));
  spawn(state().entities, {.mesh = {12345}}, ahead(20));
  tick(5);
  EXPECT_TRUE(drawn().empty());
}

TEST_F(Objects, OfAModelTypeTakeACoarserLevelFarAway) {
  const models::Registry registry = models::make_standard_registry();
  const auto& tree = registry[static_cast<models::ModelIndex>(registry.find("tree"))];
  const auto mesh = state().assets.add_model("tree", models::default_parameters(tree));
  ASSERT_TRUE(mesh) << mesh.error().message;
  mesh_ = *mesh;
  const ecs::Entity entity = put(ahead(12));
  tick(60);
  ASSERT_EQ(drawn().size(), 1u);
  const std::uint32_t near = drawn()[0].range.index_count;
  *state().entities.get<Transform>(entity) = ahead(110);
  tick(60);
  ASSERT_EQ(drawn().size(), 1u);
  EXPECT_LT(drawn()[0].range.index_count, near);
  expect_within_budget(*scene_);
}

TEST_F(Objects, OfACopiedMeshTakeACoarserLevelFarAway) {
  core::MeshData hills = box_mesh(40);
  for (glm::vec3& p : hills.positions)
    p.y = std::sin(6 * p.x) * std::sin(6 * p.z);
  const auto mesh = state().assets.add_mesh(hills);
  ASSERT_TRUE(mesh);
  const ecs::Entity entity = spawn(state().entities, {.mesh = *mesh}, ahead(6));
  tick(30);
  ASSERT_EQ(drawn().size(), 1u);
  const std::uint32_t near = drawn()[0].range.index_count;
  *state().entities.get<Transform>(entity) = ahead(110);
  tick(30);
  ASSERT_EQ(drawn().size(), 1u);
  EXPECT_LT(8 * drawn()[0].range.index_count, near);
}

TEST_F(Objects, TenThousandThatMoveShareOneMesh) {
  const std::uint64_t before = state().supply.stats().bytes;
  for (int i = 0; i < 10'000; ++i)
    put(ahead(20 + i / 100 * 0.8, (i % 100 - 50) * 0.1));
  for (int frame = 0; frame < 4; ++frame) {
    state().entities.each<Transform>([](auto, std::span<Transform> all) {
      for (Transform& transform : all)
        transform.position.local.x += 0.25;
    });
    tick();
  }
  ASSERT_EQ(drawn().size(), 10'000u);
  EXPECT_NEAR(drawn()[0].origin.x, -5 + 4 * 0.25, 1e-3);
  EXPECT_EQ(scene_->statistics().objects.missing, 0u);
  EXPECT_LT(state().supply.stats().bytes - before, 1024u) << "one mesh is charged";
}

TEST_F(Objects, InvalidMeshesAreRejected) {
  Assets& assets = state().assets;
  core::MeshData mesh = box_mesh();
  mesh.indices[0] = 77;
  const auto bad = assets.add_mesh(mesh, "door");
  ASSERT_FALSE(bad);
  EXPECT_THAT(bad.error().message, testing::StartsWith("door: indices[0]"));
  EXPECT_FALSE(assets.add_model("trea", {}));
  EXPECT_FALSE(assets.add_model("object_mesh", {}));
  const models::Registry registry = models::make_standard_registry();
  const auto& rock = registry[static_cast<models::ModelIndex>(registry.find("rock"))];
  const models::Parameters p = models::default_parameters(rock);
  EXPECT_FALSE(assets.add_model("rock", p, -1));
  EXPECT_FALSE(assets.add_model("rock", p, 0, 100));
  EXPECT_FALSE(assets.add_model("terrain", models::default_parameters(registry[0])));
  EXPECT_TRUE(assets.add_model("rock", p, 0, 1));
}

std::size_t meshes_in_memory(State& state) {
  tick(state);  // ranges come back with the tick after
  const synthesis::CacheStats stats = state.supply.stats();
  return stats.ready + stats.requested;
}

TEST_F(Objects, OfARemovedMeshAreGoneAndGetNoOtherMesh) {
  tick(2);
  const std::size_t before = meshes_in_memory(state());
  const ecs::Entity entity = put(ahead(20));
  tick(30);
  ASSERT_EQ(drawn().size(), 1u);
  EXPECT_EQ(meshes_in_memory(state()), before + 1);
  const std::size_t count = state().assets.mesh_count();
  state().assets.remove_mesh(mesh_);
  EXPECT_FALSE(state().assets.exists(mesh_));
  EXPECT_EQ(state().assets.mesh_count(), count - 1);
  const auto other = state().assets.add_mesh(box_mesh(3));
  ASSERT_TRUE(other);
  EXPECT_NE(*other, mesh_);
  tick(2);
  EXPECT_TRUE(drawn().empty());
  EXPECT_EQ(meshes_in_memory(state()), before);
  state().assets.remove_mesh(mesh_);  // again: nothing
  EXPECT_TRUE(state().assets.exists(*other));
  state().assets.remove_mesh({});
  state().entities.get<Object>(entity)->mesh = *other;
  tick(30);
  EXPECT_EQ(drawn().size(), 1u);
}

TEST_F(Objects, SeventyThousandSuccessiveMeshesTakeTheMemoryOfOne) {
  const core::MeshData box = box_mesh();
  tick(2);
  const std::size_t before = meshes_in_memory(state());
  std::optional<ecs::Entity> entity;
  for (int i = 0; i < 70'000; ++i) {
    const auto mesh = state().assets.add_mesh(box);
    ASSERT_TRUE(mesh) << i << ": " << mesh.error().message;
    mesh_ = *mesh;
    if (i % 1'000 == 0) {
      entity = put(ahead(20));
      tick(3);
      ASSERT_EQ(drawn().size(), 1u);
      state().entities.destroy(std::span(&*entity, 1));
    }
    state().assets.remove_mesh(mesh_);
  }
  tick(2);
  EXPECT_EQ(meshes_in_memory(state()), before);
}

// Object types then have other numbers, so their meshes have other keys.
TEST_F(Objects, OutliveTheirWorldAndLeaveNothingInTheCache) {
  put(ahead(20));
  const auto other = state().assets.add_mesh(box_mesh(3));
  ASSERT_TRUE(other);
  const ecs::Entity gone = spawn(state().entities, {.mesh = *other}, ahead(20, 3));
  tick(30);
  ASSERT_EQ(drawn().size(), 2u);
  const std::size_t before = meshes_in_memory(state());
  state().entities.destroy(std::span(&gone, 1));
  state().assets.remove_mesh(*other);
  Gate gate;
  models::Registry registry = models::make_standard_registry();
  world::World world = paper_world(registry);
  world.scatter.clear();
  ASSERT_TRUE(registry.add(std::make_unique<SlowType>("another", registry[0], gate)));
  const auto set = scene_->set_world(std::move(world), std::move(registry));
  ASSERT_TRUE(set) << set.error().message;
  tick(30);
  EXPECT_EQ(drawn().size(), 1u);
  EXPECT_EQ(meshes_in_memory(state()), before - 1);
  const auto later = state().assets.add_mesh(box_mesh(2));
  ASSERT_TRUE(later);
  spawn(state().entities, {.mesh = *later}, ahead(20, 3));
  tick(30);
  EXPECT_EQ(drawn().size(), 2u);
}

// A modeler is writing the mesh when it is removed.
TEST(ObjectsOfASlowType, CanBeRemovedWhileAModelerMakesThem) {
  Gate gate;
  std::unique_ptr<Scene> scene;
  const struct Opens {
    Gate& gate;
    ~Opens() { gate.set_open(true); }
  } opens{gate};  // before the modelers end
  models::Registry registry = models::make_standard_registry();
  world::World world = paper_world(registry);
  world.scatter.clear();
  const auto& rock = registry[static_cast<models::ModelIndex>(registry.find("rock"))];
  const models::Parameters parameters = models::default_parameters(rock);
  ASSERT_TRUE(registry.add(std::make_unique<SlowType>("slow", rock, gate)));
  scene = make_scene(world, gated_settings(), std::move(registry));
  State& state = state_of(*scene);
  const core::CameraPose pose = pose_at(0, 0);
  scene->settle(pose);
  for (int i = 0; i < 3; ++i)
    tick_at(*scene, pose);
  const std::uint64_t before = state.supply.stats().bytes;
  const std::size_t count = meshes_in_memory(state);
  gate.set_open(false);
  const auto mesh = state.assets.add_model("slow", parameters);
  ASSERT_TRUE(mesh) << mesh.error().message;
  Transform transform;
  transform.position = pose.position;
  transform.position.local += glm::dvec3(0, -2, -10);
  spawn(state.entities, {.mesh = *mesh}, transform);
  for (int i = 0; i < 3 || !gate.blocks(); ++i)
    tick_at(*scene, pose);
  EXPECT_EQ(state.supply.stats().requested, 1u);
  state.assets.remove_mesh(*mesh);
  for (int i = 0; i < 3; ++i)
    tick_at(*scene, pose);
  gate.set_open(true);
  while (state.supply.outstanding() > 0)
    tick_at(*scene, pose);
  for (int i = 0; i < 3; ++i)
    tick_at(*scene, pose);
  EXPECT_EQ(meshes_in_memory(state), count);
  EXPECT_EQ(state.supply.stats().bytes, before);
  EXPECT_TRUE(state.object_draws.objects.empty());
}

TEST(ObjectsInASmallBudget, CountAgainstItAndTheLeastImportantAreEvicted) {
  SceneSettings settings = small_settings();
  settings.budget_bytes = 8ull << 20;
  settings.levels_of_detail = false;  // else coarser meshes fit
  auto scene = make_scene_of(settings, [](world::World& world) { world.scatter.clear(); });
  core::CameraPose pose = pose_at(0, 0);
  scene->settle(pose);
  State& state = state_of(*scene);
  // Each mesh takes about 0.4 MiB: more of them than fit, in a row away from the camera.
  std::vector<ecs::Entity> entities;
  for (int i = 0; i < 40; ++i) {
    const auto mesh = state.assets.add_mesh(box_mesh(100));
    ASSERT_TRUE(mesh);
    Transform transform;
    transform.position = pose.position;
    transform.position.local += glm::dvec3(0, -2.0 - 0.4 * i, -10.0 - 2.5 * i);
    entities.push_back(spawn(state.entities, {.mesh = *mesh}, transform));
  }
  for (int i = 0; i < 60; ++i) {
    tick_at(*scene, pose);
    expect_within_budget(*scene);
  }
  const std::size_t drawn = state.object_draws.objects.size();
  EXPECT_GT(drawn, 4u);
  EXPECT_LT(drawn, 40u);
  EXPECT_GT(state.meshes.counts.refused, 0u);
  EXPECT_GT(state.object_draws.counts.missing, 0u);
  EXPECT_EQ(state.object_draws.counts.drawn + state.object_draws.counts.missing, 40u);
  std::set<float> distances;
  for (const render::ObjectDraw& draw : state.object_draws.objects)
    distances.insert(-draw.origin.z);
  EXPECT_LT(*distances.rbegin(), 10.0F + 2.5F * (static_cast<float>(drawn) + 4))
      << "those that are there are the nearest ones";
  // The first meshes are no longer needed: others get their memory.
  state.entities.destroy(std::span(entities).first(30));
  for (int i = 0; i < 60; ++i)
    tick_at(*scene, pose);
  EXPECT_EQ(state.object_draws.objects.size(), 10u);
  expect_within_budget(*scene);
}

}  // namespace
}  // namespace psygen::scene
