// Single models near the camera are drawn with detail, and all others without.
#include "engine/render/types.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

TEST(NearModels, AreThoseOfBarkAndStoneOfWhichSomethingIsInReach) {
  Settings settings = small_settings();
  settings.view_distance_m = 1000;
  const auto scene = make_scene(settings);
  scene->settle(pose_at(256, 256));
  tick_at(*scene, pose_at(256, 256));
  std::size_t near = 0, far = 0;
  for (const render::MeshDraw& draw : scene->state().draws.models) {
    const glm::vec3 middle = draw.origin + draw.box_center;
    const float away_m = glm::length(glm::max(glm::abs(middle) - draw.box_half_extent, 0.0F));
    ++(draw.near ? near : far);
    EXPECT_FALSE(draw.near && draw.surface == core::SurfaceKind::kPlain);
    EXPECT_FALSE(draw.near && away_m > 2 * render::kNearM) << "boxes are larger than models";
    EXPECT_TRUE(draw.near || draw.surface == core::SurfaceKind::kPlain || draw.part.count > 0 ||
                glm::length(middle) > render::kNearM);
  }
  EXPECT_GT(near, 20u);
  EXPECT_GT(far, 20u);
}

}  // namespace
}  // namespace psygen::scene
