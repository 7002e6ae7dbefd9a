// Images of water, its shore and the sun's path on it, in the world with lakes.
#include "engine/render/preset.hpp"
#include "engine/world/camera_path.hpp"
#include "engine/world/world.hpp"
#include "tests/engine/app/golden.hpp"
#include "tests/source_file.hpp"

namespace psygen::app {
namespace {

class GoldenLakes : public testing::TestWithParam<render::Preset> {};

TEST_P(GoldenLakes, LieBetweenTheirHills) {
  SessionOptions options = short_session();
  options.world_file = source_file("game/worlds/lakes.toml");
  options.preset = GetParam();
  options.size = {480, 270};
  options.scene.view_distance_m = 16000;
  options.scene.budget_bytes = 512ull << 20;
  auto session = Session::create(options);
  ASSERT_TRUE(session) << session.error().message;
  world::PathPoint point;
  point.at_m = {-1700, -1800};
  point.height_m = 32;
  point.heading_deg = 250;
  point.pitch_deg = -8;
  const core::CameraPose pose =
      world::CameraPath({}, {point}).pose_at(0, (*session)->scene().world());
  (*session)->scene().settle(pose);
  ASSERT_TRUE((*session)->tick(pose, 1.0 / 60.0));
  expect_golden("lakes_" + std::string(render::to_string(GetParam())), captured(**session));
  EXPECT_THAT((*session)->renderer().validation_messages(), testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Presets, GoldenLakes,
                         testing::Values(render::Preset::kLow, render::Preset::kHigh),
                         [](const auto& preset) {
                           return std::string(render::to_string(preset.param));
                         });

}  // namespace
}  // namespace psygen::app
