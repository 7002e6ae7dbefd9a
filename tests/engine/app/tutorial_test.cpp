// The README quotes this test: a program built on the engine.
#include <gtest/gtest.h>

#include "engine/app/session.hpp"
#include "engine/core/camera.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/statistics.hpp"
#include "tests/source_file.hpp"

namespace psygen {
namespace {

TEST(Tutorial, AProgramTurnsAroundOnceAndSavesAnImage) {
  app::SessionOptions options;
  options.world_file = source_file("game/worlds/paper.toml");
  options.headless = true;
  options.size = {320, 180};
  options.scene.view_distance_m = 200;
  auto session = app::Session::create(options);
  ASSERT_TRUE(session) << session.error().message;

  core::CameraPose pose = (*session)->home();
  ASSERT_TRUE((*session)->prepare(pose));
  for (int i = 0; i < 12; ++i) {
    pose.yaw += 0.52;
    const auto drawn = (*session)->tick(pose, 1.0 / 60.0);
    ASSERT_TRUE(drawn) << drawn.error().message;
    EXPECT_EQ((*session)->scene().statistics().drawn.holes, 0u);
  }
  const auto file = std::filesystem::path(testing::TempDir()) / "tutorial.png";
  ASSERT_TRUE((*session)->save_picture(file));
  EXPECT_GT(std::filesystem::file_size(file), 10'000u);
}

}  // namespace
}  // namespace psygen
