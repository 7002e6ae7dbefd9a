#include "engine/world/files/path_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/world/camera_path.hpp"
#include "engine/world/files/text_file.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using ::testing::AllOf;
using testing::game_file;
using ::testing::HasSubstr;
using testing::replaced;
using ::testing::StartsWith;

constexpr const char* kPath = R"(format = 1

[path]
name = "p"
origin_block = [3, 4]
smoothing_s = 2

[[point]]
time_s = 0
at_m = [1, 2]
height_m = 5
heading_deg = 90

[[point]]
time_s = 2.5
at_m = [30, 2.5]
height_m = 6
look_at_m = [100, 7]
pitch_deg = -10
)";

std::string path_error(std::string_view text) {
  const auto path = parse_camera_path(text, "p.toml");
  return path ? "accepted" : path.error().message;
}

std::string path_error_with(std::string_view from, std::string_view to) {
  return path_error(replaced(kPath, from, to));
}

TEST(PathFile, ReadsEveryField) {
  const auto path = parse_camera_path(kPath, "p.toml");
  ASSERT_TRUE(path.has_value()) << path.error().message;
  EXPECT_EQ(path->name(), "p");
  EXPECT_EQ(path->duration_seconds(), 2.5);
  ASSERT_EQ(path->points().size(), 2U);
  EXPECT_EQ(path->points()[0].heading_deg, 90);
  EXPECT_EQ(path->points()[1].at_m, glm::dvec2(30, 2.5));
  EXPECT_EQ(path->points()[1].height_m, 6);
  EXPECT_EQ(path->points()[1].look_at_m, glm::dvec2(100, 7));
  EXPECT_EQ(path->points()[1].pitch_deg, -10);
}

TEST(PathFile, APathWithoutPointsIsRejected) {
  EXPECT_THAT(path_error("format = 1\n[path]\nname = \"p\"\n"), HasSubstr("at least one point"));
  EXPECT_THAT(path_error("format = 1\npoint = []\n[path]\nname = \"p\"\n"),
              HasSubstr("at least one point"));
}

TEST(PathFile, TimesThatDoNotAscendAreRejected) {
  EXPECT_THAT(path_error_with("time_s = 2.5", "time_s = 0"),
              AllOf(StartsWith("p.toml:14: point[1].time_s: 0 is not after"),
                    HasSubstr("times must ascend")));
  EXPECT_THAT(path_error_with("time_s = 0", "time_s = 3"), HasSubstr("point[1].time_s"));
}

TEST(PathFile, NumbersOutOfRangeAndWrongTypesAreRejected) {
  EXPECT_THAT(path_error_with("time_s = 0", "time_s = nan"), HasSubstr("point[0].time_s: nan"));
  EXPECT_THAT(path_error_with("time_s = 0", "time_s = -1"), HasSubstr("point[0].time_s: -1"));
  EXPECT_THAT(path_error_with("at_m = [1, 2]", "at_m = [1e30, 2]"), HasSubstr("point[0].at_m[0]"));
  EXPECT_THAT(path_error_with("at_m = [1, 2]", "at_m = [1, inf]"), HasSubstr("point[0].at_m[1]"));
  EXPECT_THAT(path_error_with("at_m = [1, 2]", "at_m = [1, 2, 3]"), HasSubstr("array of 2"));
  EXPECT_THAT(path_error_with("height_m = 5", "height_m = 0.4"), HasSubstr("a number from 0.5 to"));
  EXPECT_EQ(path_error_with("height_m = 5", "height_m = 1.7"), "accepted")
      << "the height of an eye";
  EXPECT_THAT(path_error_with("height_m = 5", "height_m = \"5\""), HasSubstr("point[0].height_m"));
  EXPECT_THAT(path_error_with("pitch_deg = -10", "pitch_deg = 90"),
              HasSubstr("point[1].pitch_deg"));
  EXPECT_THAT(path_error_with("smoothing_s = 2", "smoothing_s = 0"), HasSubstr("path.smoothing_s"));
  EXPECT_THAT(path_error_with("[3, 4]", "[3, 4.5]"), HasSubstr("path.origin_block[1]"));
  EXPECT_THAT(path_error_with("[3, 4]", "[3, 2147483648]"), HasSubstr("path.origin_block[1]"));
}

TEST(PathFile, FlightsAboveTheMaximumSpeedAreRejected) {
  EXPECT_THAT(path_error_with("at_m = [30, 2.5]", "at_m = [1e6, 2.5]"),
              AllOf(HasSubstr("point[1].at_m"), HasSubstr("2000 m/s")));
}

TEST(PathFile, OnlyJumpsExceedTheMaximumSpeedAndTheFirstPointCannotJump) {
  const std::string far = replaced(kPath, "at_m = [30, 2.5]", "at_m = [30000, 2.5]");
  EXPECT_THAT(path_error(far), HasSubstr("or jump = true"));
  const auto path = parse_camera_path(replaced(far, "pitch_deg = -10", "jump = true"), "p.toml");
  ASSERT_TRUE(path.has_value()) << path.error().message;
  EXPECT_FALSE(path->points()[0].jump);
  EXPECT_TRUE(path->points()[1].jump);
  EXPECT_THAT(path_error_with("heading_deg = 90", "jump = true"),
              AllOf(StartsWith("p.toml:8: point[0].jump"), HasSubstr("cannot be a jump")));
  EXPECT_THAT(path_error_with("heading_deg = 90", "jump = 1"), HasSubstr("true or false"));
  EXPECT_EQ(path_error_with("heading_deg = 90", "jump = false"), "accepted");
}

TEST(PathFile, APointHasOneViewDirection) {
  EXPECT_THAT(path_error_with("heading_deg = 90", "heading_deg = 90\nlook_at_m = [0, 0]"),
              HasSubstr("not both"));
}

TEST(PathFile, MissingAndUnknownFieldsAreNamed) {
  EXPECT_THAT(path_error_with("time_s = 0\n", ""),
              HasSubstr("point[0].time_s: this field is missing"));
  EXPECT_THAT(path_error_with("at_m = [1, 2]\n", ""), HasSubstr("point[0].at_m"));
  EXPECT_THAT(path_error_with("name = \"p\"\n", ""), HasSubstr("path.name"));
  EXPECT_THAT(path_error_with("pitch_deg", "pich_deg"), HasSubstr("did you mean pitch_deg?"));
  EXPECT_THAT(path_error_with("[path]", "[paths]"), HasSubstr("did you mean path?"));
}

TEST(PathFile, EmptyNewerBinaryAndUnreadableFilesAreRejected) {
  EXPECT_THAT(path_error(""), HasSubstr("format: this field is missing"));
  EXPECT_THAT(path_error_with("format = 1", "format = 2"), HasSubstr("newer than this program"));
  EXPECT_THAT(path_error(std::string("\x00\x01\x02\xff", 4)), StartsWith("p.toml:1:"));
  EXPECT_EQ(load_camera_path("no/such.toml").error().code, core::ErrorCode::kIo);
}

TEST(PathFile, TruncatedAtEveryByteItIsAPathOrAnError) {
  const std::string text = read_text_file(game_file("paths/walk27.toml")).value();
  for (std::size_t n = 0; n <= text.size(); ++n) {
    const auto path = parse_camera_path(std::string_view(text).substr(0, n), "p.toml");
    if (!path) {
      EXPECT_THAT(path.error().message, StartsWith("p.toml:"));
    }
  }
}

}  // namespace
}  // namespace psygen::world
