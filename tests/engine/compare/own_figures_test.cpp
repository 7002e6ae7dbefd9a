#include "engine/compare/own_figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/compare/recorded_run.hpp"

namespace psygen::compare {
namespace {

using testing::HasSubstr;

std::vector<RecordedRun> runs_of(std::vector<double> means, const std::string& unit = "ms") {
  std::vector<RecordedRun> runs;
  for (const double mean : means)
    runs.emplace_back().figures = {{"path_ms", unit, mean}};
  return runs;
}

TEST(FiguresOfAGame, AreComparedByTheMeansOfTheirRuns) {
  const auto a = runs_of({1.0, 1.1, 1.2, 1.0, 1.1, 1.2, 1.1, 1.1}),
             b = runs_of({2.0, 2.1, 2.2, 2.0, 2.1, 2.2, 2.1, 2.1});
  const auto figures = compare_figures(a, b);
  ASSERT_EQ(figures.size(), 1u);
  EXPECT_NEAR(figures[0].a, 1.1, 1e-12);
  EXPECT_NEAR(figures[0].b, 2.1, 1e-12);
  EXPECT_LT(figures[0].p, 0.001);
  EXPECT_THAT(to_text(figures[0]), HasSubstr("path_ms: 1.1 and 2.1 ms, B/A 1.9091 (p 0.000)"));
  EXPECT_GT(compare_figures(a, a)[0].p, 0.5);
  EXPECT_EQ(to_text(compare_figures(runs_of({0}), runs_of({3}))[0]), "path_ms: 0 and 3 ms");
}

TEST(FiguresOfAGame, ThatSomeRunsLackOrMeasureInAnotherUnitAreNotCompared) {
  auto a = runs_of({1, 1}), b = runs_of({2, 2});
  b[1].figures.clear();
  EXPECT_EQ(compare_figures(a, b)[0].note, "not compared: 1 of 4 runs lack it");
  b = runs_of({2, 2}, "s");
  EXPECT_EQ(compare_figures(a, b)[0].note, "not compared: its unit is ms and s");
  b = runs_of({2, 2}, "");
  EXPECT_EQ(compare_figures(a, b)[0].note, "not compared: its unit is ms and none");
  b = runs_of({2, 2});
  b[0].figures[0].mean.reset();
  EXPECT_EQ(compare_figures(a, b)[0].note, "not compared: 1 of 4 runs have no value");
  EXPECT_EQ(compare_figures(runs_of({}), b).size(), 1u) << "only B has it";
}

TEST(FiguresOfAGame, AreReadFromTheSummary) {
  const std::string csv =
      "time_s,frame_ms,main_cpu_ms,apart,error_pixels,holes,missing_pixels_percent,"
      "too_coarse_percent\n0,1,,,4,0,0,0\n";
  const auto run =
      parse_run(csv,
                R"({"schema": "psygen.summary/1", "figures": {"a": {"unit": "ms", "mean": 2.5},)"
                R"( "b": {"unit": "", "mean": null}, "broken": 3}})",
                "run");
  ASSERT_TRUE(run) << run.error().message;
  ASSERT_EQ(run->figures.size(), 2u);
  EXPECT_EQ(run->figures[0].mean, 2.5);
  EXPECT_EQ(run->figures[0].unit, "ms");
  EXPECT_FALSE(run->figures[1].mean);
}

}  // namespace
}  // namespace psygen::compare
