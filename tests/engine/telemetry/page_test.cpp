#include "engine/telemetry/page.hpp"

#include <gtest/gtest.h>

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

Plot ramp(std::size_t count) {
  Plot plot;
  plot.title = "ramp";
  plot.unit = "ms";
  plot.series = {{"frame", 1, {}}};
  for (std::size_t i = 0; i < count; ++i)
    plot.series[0].values.push_back(static_cast<double>(i));
  return plot;
}

TEST(Plot, HasATitleTheUnitAndTheData) {
  const std::string html = plot_html(ramp(100));
  EXPECT_NE(html.find("<figcaption>ramp</figcaption>"), std::string::npos);
  const auto data = data_of(html);
  EXPECT_EQ(data["unit"], "ms");
  EXPECT_EQ(data["series"][0]["v"].size(), 100U);
  EXPECT_EQ(data["series"][0]["v"][99], 99.0);
}

TEST(Plot, EscapesEveryText) {
  Plot plot = ramp(10);
  const std::string evil = "</script><script>alert(1)</script>\xff";
  plot.title = plot.unit = plot.note = plot.series[0].name = evil;
  plot.series.push_back(plot.series[0]);
  plot.levels = {{evil, 3.0, false}};
  const std::string html = plot_html(plot);
  EXPECT_EQ(html.find("<script>"), std::string::npos);
  EXPECT_EQ(data_of(html)["series"][0]["name"], "</script><script>alert(1)</script>\xEF\xBF\xBD");
}

TEST(Plot, NonFiniteValuesAreNull) {
  Plot plot = ramp(10);
  plot.series[0].values[4] = std::numeric_limits<double>::quiet_NaN();
  plot.series[0].values[5] = std::numeric_limits<double>::infinity();
  const auto data = data_of(plot_html(plot));
  EXPECT_TRUE(data["series"][0]["v"][4].is_null());
  EXPECT_TRUE(data["series"][0]["v"][5].is_null());
  EXPECT_EQ(data["series"][0]["v"][6], 6.0);
}

TEST(Plot, StoresItsDrawingStyle) {
  Plot plot = ramp(3);
  plot.kind = PlotKind::kStacked;
  plot.top = 10;
  plot.zooms = false;
  plot.levels = {{"budget", 8, true}};
  const auto data = data_of(plot_html(plot));
  EXPECT_EQ(data["kind"], "stacked");
  EXPECT_EQ(data["top"], 10);
  EXPECT_EQ(data["zooms"], false);
  EXPECT_EQ(data["levels"], nlohmann::json({{{"label", "budget"}, {"value", 8}, {"below", true}}}));
}

TEST(Plot, IsAlsoDrawnForOneFrameOrNone) {
  for (const std::size_t count : {0U, 1U})
    EXPECT_EQ(data_of(plot_html(ramp(count)))["series"][0]["v"].size(), count);
}

}  // namespace
}  // namespace psygen::telemetry
