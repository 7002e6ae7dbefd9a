#include "engine/telemetry/own_figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <thread>

#include "engine/core/clock.hpp"
#include "engine/telemetry/marks.hpp"

namespace psygen::telemetry {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

std::string refusal(OwnFigures& figures, FigureInfo info) {
  const auto added = figures.add(std::move(info));
  return added ? "taken" : added.error().message;
}

std::vector<double> taken(OwnFigures& figures) {
  std::vector<double> values;
  figures.take(values);
  return values;
}

TEST(OwnFigures, AGaugeKeepsItsLastValueAndSumsBeginAgainInEveryFrame) {
  OwnFigures figures;
  auto hungry = *figures.add({.name = "wolves.hungry"});
  auto paths = *figures.add({.name = "paths", .kind = FigureKind::kCounter});
  auto search = *figures.add({.name = "search_ms", .kind = FigureKind::kDuration});
  EXPECT_EQ(figures.infos()[2].unit, "ms");
  EXPECT_TRUE(std::isnan(taken(figures)[0])) << "no value so far";
  hungry.report(3);
  hungry.report(2);
  paths.report(4);
  paths.report(5);
  search.report(0.5);
  search.report(0.25);
  EXPECT_THAT(taken(figures), ElementsAre(2, 9, 0.75));
  EXPECT_THAT(taken(figures), ElementsAre(2, 0, 0));
}

TEST(OwnFigures, ValuesThatAreNotFiniteAreLeftOutAndCounted) {
  OwnFigures figures;
  auto gauge = *figures.add({.name = "gauge"});
  auto sum = *figures.add({.name = "sum", .kind = FigureKind::kCounter});
  for (const double value : {1.0, kNotANumber, kInfinite, -kInfinite}) {
    gauge.report(value);
    sum.report(value);
  }
  EXPECT_THAT(taken(figures), ElementsAre(1, 1));
  EXPECT_THAT(figures.invalid_counts(), ElementsAre(3, 3));
}

TEST(OwnFigures, AreRefusedWithASentenceThatNamesThem) {
  OwnFigures figures;
  EXPECT_EQ(refusal(figures, {.name = "ai.paths"}), "taken");
  for (const char* name : {"", "Paths", "a b", "a..b", ".a", "a.", "größe", "a,b", "a\n"})
    EXPECT_THAT(refusal(figures, {.name = name}), HasSubstr("a name has 1 to 64 of")) << name;
  EXPECT_EQ(refusal(figures, {.name = "ai.paths", .unit = "ms"}),
            "the figure 'ai.paths': it is declared twice");
  EXPECT_THAT(refusal(figures, {.name = "ai"}), HasSubstr("differ only by words after a dot"));
  EXPECT_THAT(refusal(figures, {.name = "ai.paths.p99"}), HasSubstr("'ai.paths' differ only by"));
  EXPECT_EQ(refusal(figures, {.name = "ai.paths_ms"}), "taken");
  EXPECT_THAT(refusal(figures, {.name = "t", .unit = "s", .kind = FigureKind::kDuration}),
              HasSubstr("a duration is in ms, not in s"));
  EXPECT_THAT(refusal(figures, {.name = "t", .unit = "a\tb"}), HasSubstr("control characters"));
  EXPECT_EQ(refusal(figures, {.name = "t", .unit = "µs"}), "taken");
  figures.close();
  EXPECT_THAT(refusal(figures, {.name = "late"}), HasSubstr("declared before the first frame"));
}

TEST(OwnFigures, AHandleToNoneReportsNothing) {
  OwnFigure none;
  none.report(1);
}

TEST(OwnFigures, ThreadsReportToOneSumWithoutLosingAValue) {
  constexpr int kThreads = 4, kValues = 20'000;
  OwnFigures figures;
  const OwnFigure shared = *figures.add({.name = "sum", .kind = FigureKind::kCounter});
  double sum = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < kThreads; ++i)
      threads.emplace_back([figure = shared]() mutable {
        for (int k = 0; k < kValues; ++k)
          figure.report(1);
      });
    for (int frame = 0; frame < 100; ++frame)
      sum += taken(figures)[0];
  }
  EXPECT_EQ(sum + taken(figures)[0], double{kThreads} * kValues);
}

TEST(ScopedTime, ReportsTheMillisecondsOfItsScope) {
  OwnFigures figures;
  auto figure = *figures.add({.name = "scope_ms", .kind = FigureKind::kDuration});
  const double before_s = core::monotonic_seconds();
  {
    const ScopedTime time(figure);
    const double inside_s = core::monotonic_seconds();
    while (core::monotonic_seconds() - inside_s < 2e-3) {
    }
  }
  const double max_ms = (core::monotonic_seconds() - before_s) * 1000;
  const double ms = taken(figures)[0];
  EXPECT_GE(ms, 2 - 1e-6);
  EXPECT_LE(ms, max_ms);
}

TEST(Marks, AreTakenOnceInTheirOrder) {
  Marks marks;
  marks.set("spawn");
  marks.set("boss.second_phase");
  EXPECT_THAT(marks.take(), ElementsAre("spawn", "boss.second_phase"));
  EXPECT_TRUE(marks.take().empty());
  EXPECT_EQ(marks.ignored(), 0u);
}

TEST(Marks, WithInvalidNamesAndBeyondTheLimitAreIgnoredAndCounted) {
  Marks marks;
  for (const char* name : {"", "Boss", "a b", "end"})
    marks.set(name);
  EXPECT_EQ(marks.ignored(), 4u);
  for (std::size_t i = 0; i < kMaxMarks + 2; ++i)
    marks.set("m");
  EXPECT_EQ(marks.take().size(), kMaxMarks);
  EXPECT_EQ(marks.ignored(), 6u);
}

}  // namespace
}  // namespace psygen::telemetry
