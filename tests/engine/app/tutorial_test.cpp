// The README quotes this test: a program of its own on top of the engine.
#include <gtest/gtest.h>

#include "engine/app/app.hpp"

namespace psygen {
namespace {

TEST(Tutorial, AProgramThatTurnsAroundOnceAndTakesAPicture) {
  app::Options options;
  options.world_file = PSYGEN_SOURCE_DIR "/game/worlds/paper.toml";
  options.headless = true;
  options.size = {320, 180};
  options.scene.view_distance_m = 200;
  auto app = app::App::create(options);
  ASSERT_TRUE(app) << app.error().message;

  core::CameraPose pose = (*app)->home();
  (*app)->scene().settle(pose);
  for (int i = 0; i < 12; ++i) {
    pose.yaw += 0.52;
    const auto drawn = (*app)->frame(pose, 1.0 / 60.0);
    ASSERT_TRUE(drawn) << drawn.error().message;
    EXPECT_EQ((*app)->scene().state().counters.holes, 0u);
  }
  const auto file = std::filesystem::path(testing::TempDir()) / "tutorial.png";
  ASSERT_TRUE((*app)->save_picture(file));
  EXPECT_GT(std::filesystem::file_size(file), 10'000u);
}

}  // namespace
}  // namespace psygen
