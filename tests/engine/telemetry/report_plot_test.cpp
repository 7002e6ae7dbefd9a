#include "engine/telemetry/report_plot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

namespace psygen::telemetry {
namespace {

nlohmann::json data_of(const std::string& html) {
  const std::string opening = "<script type=\"application/json\">";
  const std::size_t start = html.find(opening) + opening.size();
  return nlohmann::json::parse(html.substr(start, html.find("</script>", start) - start));
}

struct Ramp {
  std::vector<double> times_s;
  Plot plot;
  explicit Ramp(std::size_t count) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
      times_s.push_back(0.1 * static_cast<double>(i));
      values.push_back(static_cast<double>(i));
    }
    plot.title = "ramp";
    plot.unit = "ms";
    plot.times_s = times_s;
    plot.series = {{"frame", 1, values}};
  }
};

TEST(ReportPlot, HasATitleAxesWithUnitsAndTheData) {
  const Ramp ramp(100);
  const std::string html = plot_html(ramp.plot);
  EXPECT_NE(html.find("<figcaption>ramp</figcaption>"), std::string::npos);
  EXPECT_NE(html.find(">flight time (s)</text>"), std::string::npos);
  EXPECT_NE(html.find(">ms</text>"), std::string::npos);
  const auto data = data_of(html);
  EXPECT_EQ(data["t"].size(), 100U);
  EXPECT_EQ(data["series"][0]["v"][99], 99.0);
}

TEST(ReportPlot, DoesNotGrowWithTheNumberOfFramesButKeepsPeaks) {
  Ramp ramp(100'000);
  ramp.plot.kind = PlotKind::kPeaks;
  ramp.plot.series[0].values.assign(100'000, 1.0);
  ramp.plot.series[0].values[54'321] = 77.0;
  const std::string html = plot_html(ramp.plot);
  EXPECT_LT(html.size(), 100'000U);
  const auto data = data_of(html);
  EXPECT_EQ(data["t"].size(), 900U);
  double largest = 0;
  for (const double value : data["series"][0]["v"])
    largest = std::max(largest, value);
  EXPECT_EQ(largest, 77.0);
}

TEST(ReportPlot, EscapesEverythingThatComesFromOutside) {
  Ramp ramp(10);
  const std::string evil = "</script><script>alert(1)</script>";
  ramp.plot.title = ramp.plot.unit = ramp.plot.note = ramp.plot.series[0].name = evil;
  ramp.plot.series.push_back(ramp.plot.series[0]);
  ramp.plot.levels = {{evil, 3.0, false}};
  const std::string html = plot_html(ramp.plot);
  EXPECT_EQ(html.find("<script>"), std::string::npos);
  EXPECT_EQ(data_of(html)["series"][0]["name"], evil);
}

TEST(ReportPlot, DrawsNothingOutsideItsFrameAndNoNumberThatIsNone) {
  Ramp ramp(10);
  ramp.plot.top = 3;
  ramp.plot.levels = {{"far above", 1e9, false}};
  ramp.plot.series[0].values[4] = std::numeric_limits<double>::quiet_NaN();
  ramp.plot.series[0].values[5] = std::numeric_limits<double>::infinity();
  const std::string html = plot_html(ramp.plot);
  EXPECT_EQ(html.find("nan"), std::string::npos);
  EXPECT_EQ(html.find("inf"), std::string::npos);
  EXPECT_EQ(html.find(",-"), std::string::npos);
}

TEST(ReportPlot, WhatHasNoValueIsAGapAndTheOtherSeriesStayWithTheirTimes) {
  Ramp ramp(10);
  ramp.plot.series.push_back(ramp.plot.series[0]);
  for (const std::size_t i : {3U, 4U})
    ramp.plot.series[0].values[i] = std::numeric_limits<double>::quiet_NaN();
  const std::string html = plot_html(ramp.plot);
  const auto data = data_of(html);
  EXPECT_EQ(data["x"].size(), 10U);
  EXPECT_TRUE(data["series"][0]["v"][3].is_null());
  EXPECT_EQ(data["series"][0]["v"][5], 5.0);
  EXPECT_EQ(data["series"][1]["v"][3], 3.0);
  const std::string opening = "class=\"line stroke1\" d=\"";
  const std::size_t line = html.find(opening) + opening.size();
  const std::string path = html.substr(line, html.find('"', line) - line);
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 2) << path;
}

TEST(ReportPlot, AValueWithoutNeighboursIsADot) {
  const Ramp ramp(1);
  EXPECT_NE(plot_html(ramp.plot).find("<circle class=\"fill1\""), std::string::npos);
}

TEST(ReportPlot, MarksThatLieOnTheSamePlaceAreOne) {
  Ramp ramp(10'000);
  ramp.plot.marks_s = {0, 0.1, 500, 500.05, 999};
  const std::string html = plot_html(ramp.plot);
  const std::size_t mark = html.find("class=\"mark\" d=\"");
  ASSERT_NE(mark, std::string::npos);
  const std::string path = html.substr(mark, html.find("/>", mark) - mark);
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 3) << path;
}

TEST(ReportPlot, OfOneFrameOrNoneIsStillAPlot) {
  for (const std::size_t count : {0U, 1U}) {
    const Ramp ramp(count);
    for (const PlotKind kind : {PlotKind::kLine, PlotKind::kPeaks, PlotKind::kStacked}) {
      Plot plot = ramp.plot;
      plot.kind = kind;
      EXPECT_NE(plot_html(plot).find("</svg>"), std::string::npos);
    }
  }
}

TEST(ReportPlot, StacksSeriesUpToTheirSum) {
  Ramp ramp(3);
  ramp.plot.kind = PlotKind::kStacked;
  ramp.plot.top = 10;
  ramp.plot.series = {{"a", 1, {2, 2, 2}}, {"b", 2, {3, 3, 3}}};
  const std::string html = plot_html(ramp.plot);
  // The axis runs from y = 206 (0) to y = 14 (10): 2 is at 167.6, 2 + 3 at 110.
  EXPECT_NE(html.find("class=\"stack fill2\" d=\"M 60.0,110.0"), std::string::npos);
  EXPECT_NE(html.find("60.0,167.6Z"), std::string::npos);
}

TEST(ReportPlot, TicksAreOneTwoOrFiveTimesAPowerOfTenAndNotTooMany) {
  EXPECT_DOUBLE_EQ(nice_step(10, 5), 2);
  EXPECT_DOUBLE_EQ(nice_step(10, 6), 2);
  EXPECT_DOUBLE_EQ(nice_step(30, 12), 5);
  EXPECT_DOUBLE_EQ(nice_step(0.06, 6), 0.01);
  EXPECT_DOUBLE_EQ(nice_step(51, 5), 20);
  EXPECT_GT(nice_step(0, 5), 0);
  for (double range = 1e-3; range < 1e6; range *= 1.37)
    EXPECT_LE(range / nice_step(range, 6), 6 + 1e-9) << range;
}

}  // namespace
}  // namespace psygen::telemetry
