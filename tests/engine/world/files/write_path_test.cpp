#include <gtest/gtest.h>

#include "engine/world/files/path_file.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

TEST(WritePath, WrittenPathsReadBackEqual) {
  CameraPath::Settings settings{"a \"name\"", {-3, 7}, 0.25};
  std::vector<PathPoint> points(4);
  points[0].at_m = {0.1, -2e6};
  points[0].height_m = 0.5;
  points[0].heading_deg = -270.125;
  points[1].time_s = 1.0 / 3;
  points[1].at_m = {1, 2};
  points[1].height_m = 1e5;
  points[1].look_at_m = glm::dvec2(3, 4);
  points[2].time_s = 2;
  points[2].pitch_deg = -89;
  points[3].time_s = 3;
  points[3].jump = true;
  points[1].jump = true;
  const CameraPath path(settings, points);
  const auto read = parse_camera_path(write_camera_path(path), "p.toml");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->hash(), path.hash());
  EXPECT_EQ(read->name(), path.name());
}

TEST(WritePath, KeepsThePathsThatComeWithPsygen) {
  for (const char* name : {"paths/walk27.toml", "paths/spin.toml"}) {
    const auto path = load_camera_path(testing::game_file(name));
    ASSERT_TRUE(path) << path.error().message;
    const auto again = parse_camera_path(write_camera_path(*path), name);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(again->hash(), path->hash());
  }
}

}  // namespace
}  // namespace psygen::world
