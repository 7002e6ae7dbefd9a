#include "engine/frametest/run.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/temporary_folder.hpp"

namespace psygen::frametest {
namespace {

using testing::HasSubstr;

TestResult result_of(std::vector<BudgetResult> budgets) {
  return {"dir/walk.toml", "walk", std::move(budgets), {}, 1.5, {}};
}

TestResult result_of(core::ErrorCode code) {
  return {"dir/walk.toml", "walk", {}, core::Error{code, "it <failed> & \"more\""}, 1.5, {}};
}

TEST(Judge, ComparesBudgetsWithValuesAndMissesUnmeasuredOnes) {
  telemetry::Summary summary;
  summary.frame_ms.p99 = 24.5;
  summary.low1_fps = 30.0;
  summary.hash.world = 0xABCu;
  summary.world.name = "paper";
  const std::vector<Budget> budgets{{"frame_ms.p99", Relation::kAtMost, 24.5, 1},
                                    {"frame_ms.p99", Relation::kAtMost, 24.4, 2},
                                    {"low1_fps", Relation::kAtLeast, 30.1, 3},
                                    {"hash.world", Relation::kEqual, "0000000000000abc", 4},
                                    {"world.name", Relation::kEqual, "lakes", 5},
                                    {"frame_ms.p999", Relation::kAtMost, 1e9, 6},
                                    {"system_ms.none.p99", Relation::kAtMost, 1e9, 7}};
  const auto results = judge(budgets, summary);
  std::vector<bool> holds;
  for (const BudgetResult& r : results)
    holds.push_back(r.holds);
  EXPECT_EQ(holds, (std::vector{true, false, false, true, false, false, false}));
  EXPECT_EQ(results[0].value, "24.5");
  EXPECT_EQ(results[5].value, "not measured: not measured in this run");
  EXPECT_EQ(results[6].value, "the run has no such field");
}

TEST(FrameTests, HaveALineForEachBudgetWithValueAndLimit) {
  const TestResult result = result_of({{{"frame_ms.p99", Relation::kAtMost, 25.0, 1}, "23.1", true},
                                       {{"low1_fps", Relation::kAtLeast, 30.0, 1}, "12", false}});
  EXPECT_EQ(to_text(result), "walk: frame_ms.p99 23.1  <= 25\nwalk: low1_fps 12  >= 30  MISSED\n");
}

TEST(FrameTests, ReturnTheWorstResult) {
  const Budget budget{"hitches", Relation::kAtMost, 0.0, 1};
  const TestResult held = result_of({{budget, "0", true}}),
                   missed = result_of({{budget, "1", false}});
  const TestResult failed = result_of(core::ErrorCode::kParse),
                   skipped = result_of(core::ErrorCode::kNoDevice);
  const auto code = [](std::vector<TestResult> results) { return exit_code_of(results); };
  EXPECT_EQ(code({held, held}), 0);
  EXPECT_EQ(code({held, missed}), 3);
  EXPECT_EQ(code({missed, failed}), 1);
  EXPECT_EQ(code({held, skipped}), 77);
  EXPECT_EQ(code({skipped, missed}), 3);
}

TEST(FrameTests, AreWrittenAsJUnit) {
  const Budget budget{"frame_ms.p99", Relation::kAtMost, 25.0, 1};
  const std::vector<TestResult> results{result_of({{budget, "24", true}, {budget, "26", false}}),
                                        result_of(core::ErrorCode::kIo),
                                        result_of(core::ErrorCode::kNoDevice)};
  const std::string xml = to_junit(results);
  EXPECT_THAT(xml,
              HasSubstr("tests=\"2\" failures=\"1\" errors=\"0\" skipped=\"0\" time=\"1.500\""));
  EXPECT_THAT(xml, HasSubstr("name=\"frame_ms.p99 at_most 25\"><failure message=\"26\"/>"));
  EXPECT_THAT(xml, HasSubstr("<error message=\"it &lt;failed&gt; &amp; &quot;more&quot;\"/>"));
  EXPECT_THAT(xml, HasSubstr("<skipped message="));
}

TEST(FrameTests, RunTheGamesHooksAndKeepTheOutputs) {
  const TemporaryFolder folder;
  std::ofstream(folder / "short.toml")
      << "format = 1\n[flight]\nsize = [64, 36]\nview_distance = 64\nframes = 5\nwarmup = 0\n"
         "clock = \"virtual\"\nbudget_mib = 16\n"
         "[at_most]\nframe_ms.max = 1000\n[equal]\nrun.frames = 5\n[at_least]\nframe_ms.max = "
         "999\n";
  int prepared = 0, started = 0, frames = 0;
  Hooks hooks;
  hooks.prepare = [&](app::SessionOptions& options) -> core::Result<void> {
    ++prepared;
    options.plugins.push_back(
        {.name = "game", .on_frame = [&](app::Session&, double) { ++frames; }});
    return {};
  };
  hooks.start = [&](app::Session&) -> core::Result<void> {
    return ++started, core::Result<void>{};
  };
  RunOptions options;
  options.files = {folder / "short.toml"};
  options.out = folder / "out";
  options.junit = folder / "junit.xml";
  options.worst_frames = 0;  // so the test flies only once
  EXPECT_EQ(run_frame_tests(options, hooks), kMissed) << "the last budget cannot hold";
  EXPECT_EQ(prepared, 1);
  EXPECT_EQ(started, 1);
  EXPECT_EQ(frames, 5);
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "short" / "frames.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder / "junit.xml"));
  options.device = "no such device";
  EXPECT_EQ(run_frame_tests(options, hooks), kSkipped);
}

}  // namespace
}  // namespace psygen::frametest
