#include "engine/compare/recorded_run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace psygen::compare {
namespace {

const std::string kRunSummary =
    R"({"schema": "psygen.summary/1", "run": {"width": 640, "height": 360, "fixed_step": 30,
        "warmup_seconds": 0.05}, "hash": {"world": "00ab", "images": null}})";
const std::string kHeader =
    "frame,time_s,frame_ms,main_cpu_ms,apart,error_pixels,holes,missing_pixels_percent,"
    "too_coarse_percent\n";
const std::string kRows =
    "0,0.000,90,1,,4,9,9,9\n1,0.033,10,1,picture,4,0,0,0\n2,0.067,10,1,,4,1,2,1\n"
    "3,0.100,11,1,,6,0,0,0\n4,0.133,6000,1,,5,0,1,0\n";

std::string refusal(const std::string& csv, const std::string& summary = kRunSummary) {
  const auto run = parse_run(csv, summary, "dir");
  return run ? "taken" : run.error().message;
}

TEST(RecordedRun, HoldsTheFramesAfterTheWarmUp) {
  const auto run = parse_run(kHeader + kRows, kRunSummary, "dir");
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_THAT(run->frame_ms, testing::ElementsAre(10, 11, 6000));
  EXPECT_DOUBLE_EQ(run->missing_percent, 1);
  EXPECT_DOUBLE_EQ(run->error_pixels, 5);
  EXPECT_EQ(run->holes, 1u);
  EXPECT_THAT(run->cpu_ms, testing::ElementsAre(1, 1, 1));
  EXPECT_EQ(run->fixed_step, 30);
  EXPECT_FALSE(run->virtual_clock);
}

TEST(RecordedRun, HasTheConditionsThatItsClockNeeds) {
  std::string summary = kRunSummary;
  summary.insert(
      summary.find('{') + 1,
      R"("machine":{"cpu":"EPYC","cores":2,"quota_cores":1.5},"device":{"name":"llvmpipe",)"
      R"("driver":"Mesa 22"},"build":{"revision":"12ab","clean":false},"load":{"before":0.25},)");
  const auto run = parse_run(kHeader + kRows, summary, "dir");
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(run->required, (std::vector<NamedText>{{"world hash", "00ab"},
                                                   {"size", "640x360"},
                                                   {"CPU", "EPYC"},
                                                   {"cores", "2"},
                                                   {"quota of cores", "1.5"},
                                                   {"device", "llvmpipe"},
                                                   {"driver", "Mesa 22"},
                                                   {"preset", "unknown"}}));
  EXPECT_EQ(run->shown[0], (NamedText{"revision", "12ab"}));
  EXPECT_EQ(run->shown[1], (NamedText{"no changed files", "false"}));
  EXPECT_EQ(run->shown[4], (NamedText{"load before", "0.25"}));
  const auto exact = parse_run(kHeader + "0,0.1,10,,,4,0,0,0\n", summary, "dir");
  ASSERT_TRUE(exact) << exact.error().message;
  EXPECT_EQ(exact->required.size(), 2U) << "on the virtual clock the machine does not matter";
}

TEST(RecordedRun, HasConditionsWithoutItsFrames) {
  const auto run = parse_run(kHeader + kRows, kRunSummary, "dir");
  const auto conditions = parse_conditions(kRunSummary, "dir", false);
  ASSERT_TRUE(run && conditions);
  EXPECT_EQ(conditions->required, run->required);
  EXPECT_EQ(conditions->shown, run->shown);
  EXPECT_EQ(conditions->fixed_step, 30);
  EXPECT_TRUE(conditions->frame_ms.empty());
  EXPECT_LT(parse_conditions(kRunSummary, "dir", true)->required.size(), run->required.size())
      << "on the virtual clock the machine does not count";
  EXPECT_EQ(parse_conditions("{", "dir", false).error().message,
            "dir/summary.json: it is not JSON, or is truncated");
}

TEST(RecordedRun, ALowerRenderScaleHasALargerError) {
  const std::string header = kHeader.substr(0, kHeader.size() - 1) + ",resolution\n";
  const auto run =
      parse_run(header + "0,0.1,10,1,,4,0,0,0,0.8\n1,0.2,10,1,,4,0,0,0,1\n", kRunSummary, "dir");
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_DOUBLE_EQ(run->error_pixels, 4.5);
  EXPECT_EQ(refusal(header + "0,0.1,10,1,,4,0,0,0,0\n"),
            "dir/frames.csv:2: resolution: it must be above 0 and at most 1");
}

TEST(RecordedRun, ExcludesFramesInWhichTheMachineWasSuspended) {
  const auto run = parse_run(kHeader + kRows, kRunSummary, "dir");
  ASSERT_TRUE(run);
  EXPECT_EQ(run->suspended, 1u);
  EXPECT_THAT(run->left_out, testing::ElementsAre(false, false, true));
}

TEST(RecordedRun, ReportsTheErrorOfAFileAndItsLocation) {
  EXPECT_EQ(refusal(kHeader + "0,0.1,10"),
            "dir/frames.csv: the file is truncated: its last line has no end");
  EXPECT_EQ(refusal(kHeader + "0,0.1,10\n"),
            "dir/frames.csv:2: the line has 3 cells, but the header has 9");
  EXPECT_EQ(refusal("frame,time_s\n1,1\n"), "dir/frames.csv:1: the column frame_ms is missing");
  EXPECT_EQ(refusal(kHeader + "0,0.1,1x,1,,4,0,0,0\n"),
            "dir/frames.csv:2: frame_ms: '1x' is not a number from 0 on");
  EXPECT_EQ(refusal(kHeader + "0,0.1,nan,1,,4,0,0,0\n"),
            "dir/frames.csv:2: frame_ms: 'nan' is not a number from 0 on");
  EXPECT_EQ(refusal(kHeader + "0,0.2,1,1,,4,0,0,0\n1,0.1,1,1,,4,0,0,0\n"),
            "dir/frames.csv:3: time_s: the clock goes backwards, from 0.2 to 0.1");
  EXPECT_EQ(refusal(kHeader + "0,0.1,10,x,,4,0,0,0\n"),
            "dir/frames.csv:2: main_cpu_ms: 'x' is not a number from 0 on");
  EXPECT_EQ(refusal(kHeader + "0,0.1,10,1,,4,0,0,0\n1,0.2,10,,,4,0,0,0\n"),
            "dir/frames.csv: main_cpu_ms: only some frames have it");
  EXPECT_EQ(refusal(kHeader), "dir/frames.csv: no frames after the warm-up");
  EXPECT_EQ(refusal(kHeader + kRows, "{\"schema\": "),
            "dir/summary.json: it is not JSON, or is truncated");
  EXPECT_EQ(refusal(kHeader + kRows, "{\"schema\": 3}"),
            "dir/summary.json: schema: it must be \"psygen.summary/1\"");
  EXPECT_EQ(read_run("no such folder").error().code, core::ErrorCode::kIo);
  EXPECT_EQ(read_runs("no such folder").error().code, core::ErrorCode::kIo);
}

// Any byte of either file may be wrong, and any part of its end missing.
TEST(RecordedRun, SurvivesChangedBytesAndCuts) {
  unsigned random = 1;
  const auto next = [&random] { return random = random * 1664525U + 1013904223U, random >> 8; };
  int taken = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string csv = kHeader + kRows, summary = kRunSummary;
    std::string& text = round % 2 == 0 ? csv : summary;
    for (unsigned changes = 1 + next() % 3; changes > 0; --changes)
      text[next() % text.size()] = static_cast<char>(next());
    if (round % 5 == 0) text.resize(next() % text.size());
    const auto run = parse_run(csv, summary, "dir");
    taken += run ? 1 : 0;
    EXPECT_TRUE(run || run.error().message.starts_with("dir/"));
  }
  EXPECT_GT(taken, 100);
}

}  // namespace
}  // namespace psygen::compare
