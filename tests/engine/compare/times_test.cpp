#include "engine/compare/times.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "engine/compare/viewer_csv.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::compare {
namespace {

using testing::Contains;
using testing::HasSubstr;

// A capture of 200 frames around `ms`; every tenth is twice as long.
captures::Capture make_capture(double ms) {
  captures::Capture capture;
  capture.name = fmt::format("{}.csv", ms);
  for (int i = 0; i < 200; ++i)
    capture.frame_ms.push_back(i % 10 == 0 ? 2 * ms : ms);
  return capture;
}

// Captures with a spread of 1 % from run to run.
TimesSide make_side(std::size_t count, double ms) {
  TimesSide side;
  for (std::size_t i = 0; i < count; ++i)
    side.captures.push_back(make_capture(ms * (1 + 0.01 * static_cast<double>(i % 3))));
  return side;
}

TimesComparison compared(const TimesSide& a, const TimesSide& b) {
  const auto result = compare_times(a, b);
  EXPECT_TRUE(result) << result.error().message;
  return result ? *result : TimesComparison{};
}

TEST(Times, OfOneCaptureOfEachSideAreInconclusive) {
  const TimesComparison comparison = compared(make_side(1, 10), make_side(1, 15));
  EXPECT_EQ(comparison.verdict, Verdict::kInconclusive);
  EXPECT_THAT(comparison.reasons, Contains(HasSubstr("a verdict needs 5 or more of each side")));
  ASSERT_EQ(comparison.figures.size(), 6U);
  ASSERT_TRUE(comparison.figures[0].a && comparison.figures[1].b && comparison.figures[0].ratio);
  EXPECT_NEAR(*comparison.figures[0].a, 11, 1e-9) << "mean";
  EXPECT_NEAR(*comparison.figures[1].b, 15, 1e-9) << "p50";
  EXPECT_NEAR(*comparison.figures[0].ratio, 1.5, 1e-9);
  EXPECT_FALSE(comparison.figures[0].p);
}

TEST(Times, OfFiveOfEachSideGiveAVerdict) {
  EXPECT_EQ(compared(make_side(5, 10), make_side(5, 13)).verdict, Verdict::kWorse);
  EXPECT_EQ(compared(make_side(5, 13), make_side(5, 10)).verdict, Verdict::kBetter);
  EXPECT_EQ(compared(make_side(5, 10), make_side(5, 10)).verdict, Verdict::kSame);
  const TimesComparison small = compared(make_side(5, 10), make_side(5, 10.7));
  EXPECT_EQ(small.verdict, Verdict::kSame) << "below the floor of 10 %";
  EXPECT_LE(*small.figures[0].p, 0.01) << "but no chance";
}

TEST(Times, OfShortCapturesAreJudgedWithoutP99) {
  TimesSide side = make_side(5, 10);
  for (auto& capture : side.captures)
    capture.frame_ms.resize(60);
  const TimesComparison comparison = compared(side, side);
  EXPECT_EQ(comparison.verdict, Verdict::kSame);
  EXPECT_THAT(comparison.reasons, Contains("p99: some captures have too few frames, so it is not "
                                           "judged"));
}

TEST(Times, OfNoisyCapturesAreInconclusive) {
  TimesSide a, b;
  for (const double ms : {10, 12, 14, 17, 20}) {
    a.captures.push_back(make_capture(ms));
    b.captures.push_back(make_capture(ms + 1));
  }
  const TimesComparison comparison = compared(a, b);
  EXPECT_EQ(comparison.verdict, Verdict::kInconclusive);
  EXPECT_THAT(comparison.reasons, Contains(HasSubstr("would stay unseen")));
}

TEST(Times, OfDifferentIntervalsCarryAWarning) {
  TimesSide b = make_side(1, 10);
  b.captures[0].meaning = captures::Meaning::kStarts;
  const TimesComparison comparison = compared(make_side(1, 10), b);
  EXPECT_THAT(comparison.warnings, Contains(HasSubstr("are different intervals")));
  EXPECT_TRUE(compared(make_side(1, 10), make_side(1, 10)).warnings.empty());
}

TEST(Times, SayInEveryFormThatOnlyTimesAreCompared) {
  TimesSide a = make_side(1, 10);
  a.captures[0].name = "<a>";
  a.captures[0].notes = {"left out: 3 generated frames"};
  const TimesComparison comparison = compared(a, make_side(1, 10));
  for (const std::string& form : {to_text(comparison), to_html(comparison)}) {
    EXPECT_THAT(form, HasSubstr("Only frame times are compared"));
    EXPECT_THAT(form, HasSubstr("left out: 3 generated frames"));
    EXPECT_THAT(form, HasSubstr("1 % low"));
  }
  EXPECT_THAT(to_html(comparison), HasSubstr("&lt;a&gt;"));
  EXPECT_THAT(to_json(comparison), HasSubstr("\"times_only\": true"));
}

const std::string kCapture = "Application,ProcessID,MsBetweenPresents\na,1,16.5\na,1,17.5\n";
const std::string kFrames =
    "frame,time_s,frame_ms,present_ms,gpu_ms,apart,cache_bytes,main_cpu_ms,error_pixels,holes,"
    "missing_pixels_percent,too_coarse_percent\n"
    "0,0.0,10.1234,1,5,,0,3,0,0,0,0\n1,0.5,20.5,1,5,gap,0,3,0,0,0,0\n"
    "2,1.0,12.25,1,5,,0,3,0,0,0,0\n";
const std::string kSummary =
    R"({"schema": "psygen.summary/1", "run": {"warmup_seconds": 0.4}, "world": {"name": "hills"}})";

TEST(TimesOfFolders, JoinCapturesAndRunsAndSkipFilesWithoutFrames) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "run");
  std::ofstream(folder / "run/frames.csv") << kFrames;
  std::ofstream(folder / "run/summary.json") << kSummary;
  std::ofstream(folder / "compare.json") << "{}";
  EXPECT_FALSE(holds_captures(folder / "")) << "only a run, and a file that is none";
  std::ofstream(folder / "broken.json") << "{\"a\":";
  std::ofstream(folder / "broken.csv") << "Application,MsBetweenPresents\na,-5\n";
  EXPECT_FALSE(holds_captures(folder / "")) << "a run, and damaged files";
  std::filesystem::remove(folder / "broken.json");
  std::filesystem::remove(folder / "broken.csv");
  std::ofstream(folder / "a.csv") << kCapture;
  std::ofstream(folder / "a_summary.csv") << "0.1% Min FPS\n40\n";
  EXPECT_TRUE(holds_captures(folder / ""));
  const auto side = read_times(folder / "");
  ASSERT_TRUE(side) << side.error().message;
  ASSERT_EQ(side->captures.size(), 2U);
  EXPECT_THAT(side->captures[0].frame_ms, testing::ElementsAre(16.5, 17.5));
  EXPECT_THAT(side->captures[1].frame_ms, testing::ElementsAre(12.25))
      << "without the warm-up and the excluded frame";
  EXPECT_THAT(side->skipped,
              testing::ElementsAre(HasSubstr("give the log beside it"), HasSubstr("compare.json")));
}

TEST(TimesOfFolders, FailForDamagedCapturesAndForNothing) {
  const TemporaryFolder folder;
  EXPECT_THAT(read_times(folder / "").error().message, HasSubstr("no capture"));
  std::ofstream(folder / "a.csv") << kCapture << "a,1,-5\n";
  EXPECT_TRUE(holds_captures(folder / ""));
  EXPECT_THAT(read_times(folder / "").error().message, HasSubstr("a.csv:4: '-5'"));
}

TEST(TimesOfFolders, RefuseCostsOfTheVirtualClock) {
  const TemporaryFolder folder;
  std::string frames = kFrames;
  for (std::size_t at; (at = frames.find(",0,3,")) != std::string::npos;)
    frames.replace(at, 5, ",0,,");
  std::ofstream(folder / "frames.csv") << frames;
  std::ofstream(folder / "summary.json") << kSummary;
  EXPECT_THAT(read_times(folder / "").error().message, HasSubstr("costs of the virtual clock"));
}

TEST(TimesOfFolders, ConvertedRunsHaveTheSameTimes) {
  for (const std::string_view viewer : kViewers) {
    const auto text = viewer_csv(viewer, kFrames, kSummary, "run");
    ASSERT_TRUE(text) << text.error().message;
    const auto capture = captures::parse(*text, "run.csv");
    ASSERT_TRUE(capture) << capture.error().message;
    EXPECT_THAT(capture->frame_ms, testing::ElementsAre(10.1234, 20.5, 12.25));
  }
}

}  // namespace
}  // namespace psygen::compare
