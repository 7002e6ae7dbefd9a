// Individual models near the camera are drawn with detail if the preset has it; others are not.
#include "engine/core/coordinates.hpp"
#include "engine/render/types.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

std::size_t near_draws(const State& state) {
  return static_cast<std::size_t>(
      std::ranges::count_if(state.draws.models, [](const auto& draw) { return draw.near; }));
}

// Trees and rocks that this tick draws within the distance.
std::size_t models_in_reach(State& state, const core::WorldPosition& camera) {
  std::size_t count = 0;
  state.entities.each<const MeshPlacement, const MeshDemand, const MeshSource>(
      [&](auto, std::span<const MeshPlacement> placed, std::span<const MeshDemand> demands,
          std::span<const MeshSource> sources) {
        for (std::size_t i = 0; i < placed.size(); ++i) {
          const MeshPlacement& model = placed[i];
          const glm::vec3 from_camera(
              core::offset_m(model.block, camera, state.facts.world.block_size_m()));
          const glm::vec3 middle = from_camera + model.position + model.middle;
          const bool drawn = demands[i].in_view_tick + 1 == state.clock.tick &&
                             demands[i].drawn_level != kNoLevel && !demands[i].pictured;
          if (drawn && sources[i].index < kMergedIndex &&
              model.surface != core::SurfaceKind::kPlain &&
              glm::length(middle) < render::kNearModelsM + model.radius_m)
            ++count;
        }
      });
  return count;
}

TEST(NearModels, AreBarkAndStoneWithinTheDistanceIfThePresetHasThem) {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 1000;
  const auto scene = make_scene(settings);
  State& state = state_of(*scene);
  const core::CameraPose pose = pose_at(256, 256);
  for (const bool has_detail : {false, true}) {
    state.facts.near_detail = has_detail;
    scene->settle(pose);
    tick_at(*scene, pose);
    const std::size_t expected = models_in_reach(state, pose.position);
    EXPECT_GT(expected, 20u);
    EXPECT_LT(expected + 20, state.draws.models.size());
    EXPECT_EQ(near_draws(state), has_detail ? expected : 0u);
  }
}

}  // namespace
}  // namespace psygen::scene
