// Bases made of texts: what a run leaves of its conditions and figures.
#include "engine/frametest/base.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/temporary_folder.hpp"

namespace psygen::frametest {
namespace {

using testing::HasSubstr;

telemetry::Summary summary_with(double p99_ms, double cpu_s, double pair_s) {
  telemetry::Summary summary;
  summary.machine.cpu = std::string("EPYC");
  summary.run.width = 64;
  summary.run.height = 36;
  summary.frame_ms.p99 = p99_ms;
  summary.load.cpu_seconds = cpu_s;
  if (pair_s > 0) summary.reference.pair = {pair_s, pair_s};
  return summary;
}

void write_run(const std::filesystem::path& folder, const telemetry::Summary& summary) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "summary.json") << telemetry::to_json(summary);
  std::ofstream(folder / "frames.csv")
      << "time_s,frame_ms,main_cpu_ms,apart,error_pixels,holes,missing_pixels_percent,"
         "too_coarse_percent\n0,10,5,,4,0,0,0\n0.01,11,5,,4,0,0,0\n";
}

FrameTest test_with(const char* field) {
  FrameTest test;
  test.name = "walk";
  Budget budget{field, Relation::kAtMost, 0.0, 7};
  budget.of_base = 1.1;
  test.budgets = {budget};
  return test;
}

TEST(Bases, AreTheMedianOfTheirRuns) {
  const TemporaryFolder folder;
  write_run(folder / "walk" / "run-1", summary_with(20, 2, 0.3));
  write_run(folder / "walk" / "run-2", summary_with(40, 3, 0.2));
  write_run(folder / "walk" / "run-3", summary_with(30, 4, 0.1));
  FrameTest test = test_with("frame_ms.p99");
  const auto base = load_base(folder.path(), test);
  ASSERT_TRUE(base) << base.error().message;
  EXPECT_EQ(base->runs.size(), 3u);
  ASSERT_TRUE(set_limits(test, *base));
  EXPECT_DOUBLE_EQ(std::get<double>(test.budgets[0].limit), 33);
  EXPECT_DOUBLE_EQ(*base->usual().pair_s, 0.15) << "lower quartile";
  EXPECT_EQ(*base->usual().cpu_s, 3);
  EXPECT_EQ(base->usual().source, "the base");
}

TEST(Bases, MayBeTheFolderOfARun) {
  const TemporaryFolder folder;
  write_run(folder / "run", summary_with(20, 2, 0));
  const auto base = load_base(folder / "run", test_with("frame_ms.p99"));
  ASSERT_TRUE(base) << base.error().message;
  EXPECT_EQ(base->usual().pair_s.reason, "the base measured no reference load");
}

TEST(Bases, AreRefusedWithoutTheirFigureOrWithDifferentRuns) {
  const TemporaryFolder folder;
  write_run(folder / "walk" / "run-1", summary_with(20, 2, 0));
  FrameTest test = test_with("frame_ms.p999");
  auto base = load_base(folder.path(), test);
  ASSERT_TRUE(base) << base.error().message;
  const auto set = set_limits(test, *base);
  ASSERT_FALSE(set);
  EXPECT_THAT(set.error().message,
              HasSubstr("walk: the base has no frame_ms.p999, to which the budget in line 7 is "
                        "relative: not measured"));
  telemetry::Summary other = summary_with(20, 2, 0);
  other.machine.cpu = std::string("Xeon");
  write_run(folder / "walk" / "run-2", other);
  base = load_base(folder.path(), test);
  ASSERT_FALSE(base);
  EXPECT_THAT(base.error().message,
              HasSubstr("run-2 has other conditions than the base: different CPU: EPYC and Xeon"));
  std::ofstream(folder / "walk" / "run-1" / "summary.json") << "{";
  EXPECT_THAT(load_base(folder.path(), test).error().message, HasSubstr("it is not JSON"));
}

TEST(Bases, AreComparedByTheConditionsOfCompare) {
  const TemporaryFolder folder;
  write_run(folder / "walk", summary_with(20, 2, 0));
  const auto base = load_base(folder.path(), test_with("frame_ms.p99"));
  ASSERT_TRUE(base) << base.error().message;
  telemetry::Summary same = summary_with(99, 9, 0), other = same;
  EXPECT_TRUE(check_conditions(*base, telemetry::to_json(same), false));
  other.machine.cpu = std::string("Xeon");
  other.run.width = 65;
  EXPECT_THAT(check_conditions(*base, telemetry::to_json(other), false).error().message,
              HasSubstr("this run has other conditions than the base: different size: 64x36 and "
                        "65x36, different CPU: EPYC and Xeon"));
  EXPECT_THAT(check_conditions(*base, telemetry::to_json(same), true).error().message,
              HasSubstr("different clocks: wall and virtual"));
}

}  // namespace
}  // namespace psygen::frametest
