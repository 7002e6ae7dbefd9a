#include "engine/telemetry/curve_plot.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace psygen::telemetry {
namespace {

std::size_t count(const std::string& text, const std::string& words) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(words, at)) != std::string::npos; ++at)
    ++found;
  return found;
}

CurvePlot plot_of(std::vector<double> x, std::vector<double> values) {
  return {"rock",
          "subdivisions",
          "µs",
          "",
          std::move(x),
          {{"measured", 1, CurveKind::kPoints, values}, {"c·n", 2, CurveKind::kLine, values}}};
}

TEST(CurvePlot, DrawsAPointForEachValueAndALineThroughThem) {
  const std::string html = curve_plot_html(plot_of({1, 2, 3}, {5, 10, 20}));
  EXPECT_EQ(count(html, "<circle"), 3u);
  EXPECT_EQ(count(html, "<polyline"), 1u);
  EXPECT_EQ(count(html, "swatch"), 2u);
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

TEST(CurvePlot, OmitsNonFiniteValues) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const std::string html = curve_plot_html(plot_of({1, 2, 3}, {5, nothing, 20}));
  EXPECT_EQ(count(html, "class=\"fill1"), 2u);
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

TEST(CurvePlot, ALineEndsAtAMissingValueAndASingleValueIsARing) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  CurvePlot plot = plot_of({1, 2, 3, 4, 5, 6}, {5, 6, nothing, 7, nothing, nothing});
  plot.curves.erase(plot.curves.begin());
  const std::string html = curve_plot_html(plot);
  EXPECT_EQ(count(html, "<polyline"), 1u);
  EXPECT_EQ(count(html, "class=\"ring"), 1u);
  const std::size_t points = html.find("points=\"") + 8;
  EXPECT_EQ(count(html.substr(points, html.find("/>", points) - points), ","), 2u);
}

TEST(CurvePlot, ACurveWithoutValuesIsNotInTheLegend) {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  CurvePlot plot = plot_of({1, 2}, {5, 6});
  plot.curves.push_back({"cost model", 3, CurveKind::kLine, {nothing, nothing}});
  const std::string html = curve_plot_html(plot);
  EXPECT_EQ(count(html, "swatch"), 2u);
  EXPECT_EQ(html.find("cost model"), std::string::npos);
}

TEST(CurvePlot, IsAlsoDrawnForOnePointOrNone) {
  for (const CurvePlot& plot : {plot_of({}, {}), plot_of({4}, {0})}) {
    const std::string html = curve_plot_html(plot);
    EXPECT_EQ(count(html, "<svg"), 1u);
    EXPECT_EQ(html.find("nan"), std::string::npos);
    EXPECT_EQ(html.find("inf"), std::string::npos);
  }
}

TEST(CurvePlot, EscapesAllOfItsTexts) {
  CurvePlot plot = plot_of({1}, {1});
  plot.title = "<script>";
  plot.note = "a & b";
  plot.x_name = plot.curves[0].name = "\"x\"";
  const std::string html = curve_plot_html(plot);
  EXPECT_EQ(html.find("<script>"), std::string::npos);
  EXPECT_EQ(count(html, "a &amp; b"), 1u);
  EXPECT_EQ(html.find("\"x\""), std::string::npos);
}

TEST(CurvePlot, TicksAreOneTwoOrFiveTimesAPowerOfTenAndNotTooMany) {
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
