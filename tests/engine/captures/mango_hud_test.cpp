#include <fmt/format.h>

#include "tests/engine/captures/fixture.hpp"

namespace psygen::captures {
namespace {

using testing::HasSubstr;

const std::string kSystem = "os,cpu,gpu,ram,kernel,driver\nX,C,G,1,6,a,driver,with,commas\n";
const std::string kFrames = "fps,frametime,cpu_load,elapsed\n";

// A row; `elapsed_ms` is the time since the start.
std::string row(double fps, double time, double elapsed_ms) {
  return fmt::format("{:.3f},{},50,{:.0f}\n", fps, time, elapsed_ms * 1e6);
}

TEST(MangoHud, SinceZeroPointSevenLogsMilliseconds) {
  const Capture capture = read_text(kSystem + kFrames + row(100, 10, 10) + row(50, 20, 30));
  EXPECT_THAT(capture, times_are({10, 20}));
  EXPECT_EQ(capture.tool, "MangoHud 0.7 or later");
  EXPECT_EQ(capture.meaning, Meaning::kPresents);
}

TEST(MangoHud, ZeroPointSixLogsMicrosecondsWhateverTheSmoothedRateSays) {
  const Capture capture = read_text(kSystem + kFrames + row(70, 10'000, 10) + row(70, 20'000, 30) +
                                    row(70, 12'500, 42.5));
  EXPECT_THAT(capture, times_are({10, 20, 12.5}));
  EXPECT_EQ(capture.tool, "MangoHud 0.6");
}

TEST(MangoHud, WithVersionsHasItsHeaderInLineSeven) {
  EXPECT_EQ(read_text("v1\nv0.8.1\n----SYSTEM INFO----\n" + kSystem + "----FRAME METRICS----\n" +
                      kFrames + row(100, 10, 10))
                .tool,
            "MangoHud 0.8.1");
}

TEST(MangoHud, LeavesOutACutLastRowButNoWholeOneWithoutAnEnd) {
  const std::string text = kSystem + kFrames + row(100, 10, 10) + row(50, 20, 30);
  const Capture cut = read_text(text + "60.0,16.6");
  EXPECT_THAT(cut, times_are({10, 20}));
  EXPECT_THAT(cut, notes_with("the cut last row"));
  EXPECT_THAT(read_text(text.substr(0, text.size() - 1)), times_are({10, 20}));
  EXPECT_THAT(error_of(kSystem + kFrames + "60.0,16.6\n" + row(100, 10, 10)),
              HasSubstr("log.csv:4: the line has 2 cells"));
}

TEST(MangoHud, RefusesRatesAndSampledLogs) {
  EXPECT_THAT(error_of(kSystem + "fps,cpu_load,elapsed\n88,12,100\n88,12,50100\n"),
              HasSubstr("rates every 50 ms, no frame times; log with log_interval=0"));
  EXPECT_THAT(error_of(kSystem + "88,12,100\n88,12,50100\n"), HasSubstr("log_interval=0"));
  std::string sampled = kSystem + kFrames;
  for (int i = 0; i < 6; ++i)
    sampled += row(100, 10, 70.0 * i);
  EXPECT_THAT(error_of(sampled), HasSubstr("frames of about 10 ms, but rows 70 ms apart, so it "
                                           "has one frame in 7; log with log_interval=0"));
  EXPECT_THAT(error_of("0.1% Min FPS,Average FPS\n40,60\n"),
              HasSubstr("a summary of MangoHud, no frames; give the log beside it"));
}

TEST(MangoHud, RefusesTwoProgramsInALogAndAClockThatGoesBackwards) {
  std::string mixed = kSystem + kFrames;
  for (int i = 0; i < 20; ++i)
    mixed += row(100, 10, 5.0 * i);
  EXPECT_THAT(error_of(mixed), HasSubstr("two programs logged into the file"));
  EXPECT_THAT(error_of(kSystem + kFrames + row(100, 10, 20) + row(100, 10, 10)),
              HasSubstr("log.csv:5: elapsed: the clock goes backwards"));
}

TEST(Mangoapp, LeavesOutTheTimeAsleep) {
  const Capture capture =
      read_text(kSystem + kFrames + row(100, 10, 10) + row(0.1, 9000, 9010) + row(80, 12.5, 9022.5),
                "logs/mangoapp_1.csv");
  EXPECT_THAT(capture, times_are({10, 12.5}));
  EXPECT_EQ(capture.meaning, Meaning::kDisplayed);
  EXPECT_THAT(capture, notes_with("20 times the median): 1"));
}

}  // namespace
}  // namespace psygen::captures
