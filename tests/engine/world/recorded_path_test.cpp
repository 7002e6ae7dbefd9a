#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "engine/world/camera_path.hpp"
#include "engine/world/files/path_file.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

World recorded_world() {
  return load_world(testing::game_file("worlds/paper.toml"), testing::registry()).value();
}

// A walk with a full turn, over the border of blocks.
std::vector<TimedPose> recorded_walk(const World& world) {
  std::vector<TimedPose> poses;
  for (int i = 0; i < 40; ++i) {
    TimedPose at{100 + i * 0.1, {{{256, 256}, {i * 4.0, 200 + 10 * std::sin(i * 0.1), 3.0}}}};
    at.pose.yaw = i * 0.2;
    at.pose.pitch = -0.3;
    at.pose.position = core::normalised(at.pose.position, world.block_size_m());
    poses.push_back(at);
  }
  return poses;
}

TEST(RecordedPath, PassesTheRecordedPoses) {
  const World world = recorded_world();
  const std::vector<TimedPose> poses = recorded_walk(world);
  const CameraPath path = recorded_path("walk", poses, world);
  for (const TimedPose& at : poses) {
    const core::CameraPose pose = path.pose_at(at.time_s - 100, world);
    const glm::dvec3 off =
        core::offset_m(pose.position.block, at.pose.position, world.block_size_m()) +
        pose.position.local;
    EXPECT_LT(glm::length(off), 0.01) << at.time_s;
    EXPECT_NEAR(std::remainder(pose.yaw - at.pose.yaw, 6.283185307179586), 0, 1e-9);
    EXPECT_NEAR(pose.pitch, at.pose.pitch, 1e-9);
  }
}

TEST(RecordedPath, IsReadBackFromItsFile) {
  const World world = recorded_world();
  const CameraPath path = recorded_path("walk", recorded_walk(world), world);
  const auto read = parse_camera_path(write_camera_path(path), "p.toml");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->hash(), path.hash());
}

TEST(RecordedPath, JumpsBetweenDistantPoses) {
  const World world = recorded_world();
  std::vector<TimedPose> poses = recorded_walk(world);
  for (std::size_t i = 20; i < poses.size(); ++i)
    poses[i].pose.position.block.x -= 30;
  poses[5].pose.position.local.y = -1e6;  // below the ground
  const CameraPath path = recorded_path("leap", poses, world);
  EXPECT_TRUE(path.points()[20].jump);
  EXPECT_FALSE(path.points()[19].jump || path.points()[21].jump);
  EXPECT_EQ(path.points()[5].height_m, CameraPath::kMinHeightM);
  EXPECT_TRUE(parse_camera_path(write_camera_path(path), "p.toml"));
}

}  // namespace
}  // namespace psygen::world
