#include "engine/telemetry/frame_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "tests/engine/telemetry/synthetic_flight.hpp"
#include "tests/full_disk.hpp"

namespace psygen::telemetry {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}

TEST(FrameLog, ExcludesFramesThatStartDuringTheWarmUp) {
  FrameLog log({"render"});
  for (std::uint64_t i = 0; i < 10; ++i) {
    FrameRecord record;
    record.index = i;
    record.time_s = 0.25 * static_cast<double>(i);
    log.add(record);
  }
  ASSERT_EQ(log.frames_since(1.0).size(), 6U);
  EXPECT_EQ(log.frames_since(1.0).front().index, 4U);
  EXPECT_TRUE(log.frames_since(100.0).empty());
}

TEST(FrameLog, CountsFramesBeyondItsCapacity) {
  FrameLog log({"render"}, 3);
  for (int i = 0; i < 5; ++i)
    log.add({});
  EXPECT_EQ(log.frames().size(), 3U);
  EXPECT_EQ(log.dropped_frames(), 2U);
}

TEST(FrameLog, AddingAFrameNeverMovesTheOthers) {
  FrameLog log({"render"}, 1000);
  log.add({});
  const FrameRecord* first = log.frames().data();
  for (int i = 0; i < 999; ++i)
    log.add({});
  EXPECT_EQ(log.frames().data(), first);
}

TEST(FrameLog, CostErrorIsRelativeToTheActualTime) {
  FrameLog log({});
  log.add_cost_error(0, 1.5e-3, 1e-3);
  log.add_cost_error(0, 1.0e-3, 2e-3);
  log.add_cost_error(0, 1.0e-3, 0);
  const std::vector<double> errors = log.cost_error_percent().values_since(0);
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_NEAR(errors[0], 50.0, 1e-9);
  EXPECT_NEAR(errors[1], 50.0, 1e-9);
}

TEST(FramesCsv, HasAHeaderAndOneRowPerFrameWithTheSameNumberOfFields) {
  const TemporaryFolder folder;
  const FrameLog log = synthetic_flight(25);
  ASSERT_TRUE(write_frames_csv(folder / "frames.csv", log));
  const std::vector<std::string> lines = lines_of(text_of(folder / "frames.csv"));
  ASSERT_EQ(lines.size(), 26U);
  for (const std::string& line : lines)
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 12 + 8 + 27 - 1) << line;
  EXPECT_EQ(lines[0].rfind("frame,time_s,frame_ms,", 0), 0U);
  EXPECT_NE(lines[0].find(",input_ms,streaming_ms,visibility_ms,"), std::string::npos);
  EXPECT_EQ(lines[25].rfind("24,", 0), 0U);
}

TEST(FramesCsv, HoldsTheValuesUnderTheirNames) {
  const TemporaryFolder folder;
  FrameLog log({"render"});
  FrameRecord r;
  r.index = 7;
  r.time_s = 1.5;
  r.frame_ms = 16.25;
  constexpr std::array kSystemMs{12.5F};
  r.error_pixels = 5.25;
  r.resolution = 0.75;
  r.triangles = 123'456;
  r.cache_bytes = 1ULL << 33;
  log.add(r, kSystemMs);
  ASSERT_TRUE(write_frames_csv(folder / "frames.csv", log));
  r.device_wait_ms = 2;
  r.acquire_ms = 0.5;
  r.present_ms = 0.25;
  r.record_ms = 0.75;
  r.gpu_ms = 14;
  r.gpu_shadows_ms = 3;
  r.apart = Apart::kPicture;
  log.add(r, kSystemMs);
  ASSERT_TRUE(write_frames_csv(folder / "frames.csv", log));
  const std::vector<std::string> lines = lines_of(text_of(folder / "frames.csv"));
  const std::string after =
      ",12.5000,5.250,1.000,0.750,123456,0,0,0,0,0.0000,0.0000,8589934592,0,0,0,0,0,0,0,0,0,0,0,0."
      "000000,,,,";
  EXPECT_EQ(lines[1], "7,1.500000,16.2500,0.0000,0.0000,0.0000,0.0000,0.0000,0.0000,,," + after)
      << "the GPU time is unknown";
  EXPECT_EQ(lines[2],
            "7,1.500000,16.2500,0.0000,2.7500,2.0000,0.5000,0.2500,0.7500,14.0000,"
            "3.0000,picture" +
                after);
}

TEST(FrameLog, TimesOfOtherSystemsThanItsOwnAreUnknown) {
  const TemporaryFolder folder;
  FrameLog log({"input", "render"});
  log.add({}, std::array{1.0F, 2.0F});
  log.add({}, std::array{1.0F, 9.0F, 2.0F});
  log.add({});
  EXPECT_EQ(log.system_ms(0)[1], 2.0F);
  EXPECT_TRUE(std::isnan(log.system_ms(1)[1]));
  EXPECT_TRUE(std::isnan(log.system_ms(2)[0]));
  ASSERT_TRUE(write_frames_csv(folder / "frames.csv", log));
  const std::vector<std::string> lines = lines_of(text_of(folder / "frames.csv"));
  EXPECT_NE(lines[1].find(",1.0000,2.0000,"), std::string::npos) << lines[1];
  EXPECT_EQ(lines[2].find("nan"), std::string::npos) << lines[2];
}

TEST(FrameLog, AGpuTimeBelongsToItsFrameAlthoughItArrivesLater) {
  FrameLog log({});
  for (std::uint64_t i = 0; i < 40; ++i) {
    FrameRecord record;
    record.index = i;
    record.device_frame = i == 37 ? 0 : 100 + i;  // one was not drawn
    log.add(record);
    if (i >= 4) log.set_gpu_ms(100 + i - 4, 5.0 + static_cast<double>(i - 4), 1.0);
  }
  log.set_gpu_ms(101, 99.0, 99.0);  // more than 16 frames ago
  log.set_gpu_ms(7, 99.0, 99.0);    // never drawn
  for (std::uint64_t i = 0; i < 36; ++i) {
    ASSERT_TRUE(log.frames()[i].gpu_ms) << i;
    EXPECT_EQ(*log.frames()[i].gpu_ms, 5.0 + static_cast<double>(i));
    EXPECT_EQ(*log.frames()[i].gpu_shadows_ms, 1.0);
  }
  for (std::uint64_t i = 36; i < 40; ++i)
    EXPECT_FALSE(log.frames()[i].gpu_ms) << i;
}

TEST(FramesCsv, IsCompleteOrAbsentWhenTheDiskFills) {
  const FrameLog log = synthetic_flight(1000);
  expect_whole_files(
      [&log](const auto& folder) { return write_frames_csv(folder / "frames.csv", log); });
}

TEST(FramesCsv, NamesAMissingFolder) {
  const auto result = write_frames_csv("/nowhere/frames.csv", synthetic_flight(1));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, core::ErrorCode::kIo);
  EXPECT_NE(result.error().message.find("/nowhere/frames.csv"), std::string::npos);
}

}  // namespace
}  // namespace psygen::telemetry
