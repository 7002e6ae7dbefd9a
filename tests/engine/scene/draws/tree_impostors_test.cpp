// Individual trees that are small in the frame, and all trees of coarse nodes, are impostors.
#include "engine/world/far/tree_impostors.hpp"

#include <algorithm>

#include "engine/scene/meshes/mesh_choice.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

SceneSettings wide_settings(double error_pixels) {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 1000;
  settings.max_error_pixels = error_pixels;
  return settings;
}

struct Drawn {
  std::size_t quads = 0, merged = 0, meshes = 0;
  float largest = 0;  // in pixels, of a quad
};

Drawn drawn_at(Scene& scene) {
  scene.settle(pose_at(256, 256));
  tick_at(scene, pose_at(256, 256));
  const State& s = state_of(scene);
  Drawn drawn;
  for (const render::MeshDraw& draw : s.draws.models) {
    if (!draw.pictured) {
      ++drawn.meshes;
      continue;
    }
    const bool quad = draw.range.vertex_count == 4;
    ++(quad ? drawn.quads : drawn.merged);
    if (!quad) continue;
    const float size_m = 2 * std::min(draw.box_half_extent.x, draw.box_half_extent.y);
    drawn.largest = std::max(drawn.largest, size_m * s.camera.pixels_per_radian /
                                                glm::length(draw.origin + draw.box_centre));
  }
  return drawn;
}

TEST(TreeImpostors, AreImpostorsWhereTheyAreSmall) {
  const auto coarse = make_scene(wide_settings(13));
  const Drawn drawn = drawn_at(*coarse);
  EXPECT_GT(drawn.quads, 20U);
  EXPECT_GT(drawn.merged, 5U);
  EXPECT_LT(drawn.largest, kMaxPicturePixels);
  expect_consistent(*coarse);
  const auto fine = make_scene(wide_settings(1));
  EXPECT_LT(drawn_at(*fine).largest, drawn.largest / 2);
}

TEST(TreeImpostors, AreMeshesIfEveryLevelIsMadeOnce) {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 64;
  settings.budget_bytes = 512ull << 20;
  settings.paradigm = Paradigm::kDataAmplification;
  const auto scene = make_scene(settings);
  EXPECT_EQ(state_of(*scene).facts.pictures, nullptr);
  const auto made = scene->amplify(pose_at(256, 256));
  ASSERT_TRUE(made) << made.error().message;
  tick_at(*scene, pose_at(256, 256));
  for (const render::MeshDraw& draw : state_of(*scene).draws.models)
    EXPECT_FALSE(draw.pictured);
}

TEST(TreeImpostors, HaveTheirMeshKeyAtEveryLevel) {
  const auto scene = make_scene(wide_settings(13));
  scene->settle(pose_at(256, 256));
  std::size_t pictured = 0;
  state_of(*scene).entities.each<const MeshPlacement, const MeshSource, const LodErrors>(
      [&](std::span<const ecs::Entity>, std::span<const MeshPlacement> placed,
          std::span<const MeshSource> sources, std::span<const LodErrors> details) {
        for (std::size_t i = 0; i < sources.size(); ++i) {
          for (std::uint8_t level = 0; level < details[i].level_count; ++level) {
            const synthesis::MeshKey key = key_of(placed[i], details[i], sources[i], level);
            EXPECT_EQ(level_of(details[i], sources[i], key), level);
          }
          if (details[i].picture_level == kNoLevel) continue;
          ++pictured;
          EXPECT_EQ(details[i].picture_level + 1U, details[i].level_count);
        }
      });
  EXPECT_GT(pictured, 100U);
}

}  // namespace
}  // namespace psygen::scene
