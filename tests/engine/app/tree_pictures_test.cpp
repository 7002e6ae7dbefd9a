// The renderer receives the impostors of trees before the first frame, and draws without them if it
// lacks memory for them.
#include <algorithm>

#include "engine/scene/state.hpp"
#include "engine/world/far/tree_impostors.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

std::unique_ptr<render::Renderer> small_renderer(std::uint64_t texture_bytes) {
  render::RendererOptions options;
  options.size = {160, 90};
  options.geometry_budget_bytes = small_settings().budget_bytes;
  options.texture_budget_bytes = texture_bytes;
  auto made = render::Renderer::create(options);
  EXPECT_TRUE(made);
  return made ? std::move(*made) : nullptr;
}

std::unique_ptr<Scene> scene_of(render::Renderer& renderer) {
  models::Registry registry = models::make_standard_registry();
  const world::World world = paper_world(registry);
  auto scene = Scene::create(world, std::move(registry), small_settings(), &renderer);
  EXPECT_TRUE(scene);
  return scene ? std::move(*scene) : nullptr;
}

TEST(PicturesOfTrees, AreUploadedBeforeTheFirstFrame) {
  const auto renderer = small_renderer(64U << 20);
  ASSERT_TRUE(renderer);
  const auto scene = scene_of(*renderer);
  ASSERT_TRUE(scene);
  const State& s = scene::state_of(*scene);
  ASSERT_TRUE(s.facts.pictures);
  EXPECT_EQ(s.meshes.pictures_lacking, (1U << s.facts.pictures->count()) - 1);
  EXPECT_EQ(renderer->texture_bytes(), s.facts.pictures->count() * core::impostor_bytes());
  scene->settle(pose_at(256, 256));
  EXPECT_EQ(s.meshes.pictures_lacking, 0U);
  EXPECT_FALSE(s.output.error);
}

TEST(PicturesOfTrees, AreNotLostIfFinishedWhileTheWorldIsReplaced) {
  const auto renderer = small_renderer(64U << 20);
  ASSERT_TRUE(renderer);
  models::Registry registry = models::make_standard_registry(),
                   next = models::make_standard_registry();
  world::World world = paper_world(registry);
  SceneSettings settings = small_settings();
  settings.virtual_time = false;
  auto made = Scene::create(world, std::move(registry), settings, renderer.get());
  ASSERT_TRUE(made);
  Scene& scene = **made;
  const State& s = scene::state_of(scene);
  // Until some are finished and not yet uploaded.
  const auto is_picture = [&s](const synthesis::Completion& job) {
    return job.key.model == s.facts.picture_model;
  };
  bool made_some = false;
  for (int i = 0; i < 100 && !made_some; ++i) {
    tick_at(scene, pose_at(256, 256));
    scene::state_of(scene).supply.wait();
    made_some = std::ranges::any_of(scene::state_of(scene).supply.collect(), is_picture);
  }
  ASSERT_TRUE(made_some);
  ASSERT_NE(s.meshes.pictures_lacking, 0U);
  world.scatter[1].count += 1;
  ASSERT_TRUE(scene.set_world(world, std::move(next)));
  scene.settle(pose_at(256, 256));
  EXPECT_EQ(s.meshes.pictures_lacking, 0U);
}

TEST(PicturesOfTrees, AreReplacedByMeshesIfTheRendererLacksMemory) {
  const auto renderer = small_renderer(1U << 20);
  ASSERT_TRUE(renderer);
  const auto scene = scene_of(*renderer);
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene::state_of(*scene).facts.pictures, nullptr);
  scene->settle(pose_at(256, 256));
  tick_at(*scene, pose_at(256, 256));
  EXPECT_GT(scene::state_of(*scene).draws.models.size(), 10U);
  for (const render::MeshDraw& draw : scene::state_of(*scene).draws.models)
    EXPECT_FALSE(draw.pictured);
}

}  // namespace
}  // namespace psygen::scene
