#include "engine/scene/view/debug_colours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "engine/render/preset.hpp"

namespace psygen::scene {
namespace {

TEST(DebugColours, EveryLevelUpToTheEighthHasItsOwnColour) {
  std::set<std::uint32_t> colours;
  for (std::uint32_t level = 0; level < 8; ++level)
    colours.insert(colour_of(render::View::kLevels, {.level = level}));
  EXPECT_EQ(colours.size(), 8u);
}

TEST(DebugColours, LayersGetDarkerAndStayColours) {
  std::uint32_t last = 256;
  for (std::uint32_t layer = 0; layer < 15; ++layer) {
    const std::uint32_t red = colour_of(render::View::kLayers, {.layer = layer}) >> 16;
    EXPECT_LT(red, last);
    last = red;
  }
  EXPECT_LE(colour_of(render::View::kLayers, {.layer = 60'000}), 0xFFFFFFu);
}

TEST(DebugColours, MissingDetailStandsOut) {
  const std::uint32_t fine = colour_of(render::View::kMissing, {.coarser = 0});
  const std::uint32_t nearly = colour_of(render::View::kMissing, {.coarser = 1});
  EXPECT_NE(fine, nearly);
  EXPECT_NE(nearly, colour_of(render::View::kMissing, {.coarser = 2}));
  EXPECT_EQ(colour_of(render::View::kMissing, {.coarser = 2}),
            colour_of(render::View::kMissing, {.coarser = 5}));
}

// The text beside a colour; empty if the legend does not have it.
std::string meaning(render::View view, std::uint32_t colour, std::size_t levels = 8) {
  std::string text;
  for (const render::TextLine& line : legend_of(view, levels, true)) {
    if (line.swatch != colour) continue;
    EXPECT_TRUE(text.empty()) << "a colour that means two things: " << text << ", " << line.text;
    text = line.text;
  }
  return text;
}

TEST(DebugColours, TheLegendExplainsEachColour) {
  for (const render::View view : {render::View::kLevels, render::View::kBounds}) {
    for (std::uint32_t level = 0; level < 8; ++level)
      EXPECT_EQ(meaning(view, colour_of(view, {.level = level})).front(), '0' + level);
    EXPECT_EQ(meaning(view, colour_of(view, {.level = 9}), 10), "1, 9");
  }
  EXPECT_EQ(meaning(render::View::kMissing, colour_of(render::View::kMissing, {})),
            "as fine as wanted");
  EXPECT_EQ(meaning(render::View::kMissing, colour_of(render::View::kMissing, {.coarser = 1})),
            "one level too coarse");
  EXPECT_EQ(meaning(render::View::kMissing, colour_of(render::View::kMissing, {.coarser = 3})),
            "two levels or more");
  EXPECT_EQ(meaning(render::View::kLayers, colour_of(render::View::kLayers, {})),
            "where the camera is");
  EXPECT_EQ(meaning(render::View::kLayers, colour_of(render::View::kLayers, {.layer = 6})),
            "6 nodes away");
  EXPECT_EQ(meaning(render::View::kLayers, colour_of(render::View::kLayers, {.layer = 99})),
            "15 and more");
  const auto cache = [](float bytes) {
    return meaning(render::View::kCache, colour_of(render::View::kCache, {.bytes_per_m2 = bytes}));
  };
  EXPECT_EQ(cache(0), "below 1/16");
  EXPECT_EQ(cache(1.0F / 16), "1/16 to 1/4");
  EXPECT_EQ(cache(0.3F), "1/4 to 1");
  EXPECT_EQ(cache(3.9F), "1 to 4");
  EXPECT_EQ(cache(4), "4 to 16");
  EXPECT_EQ(cache(63), "16 to 64");
  EXPECT_EQ(cache(1e9F), "64 and more");
}

TEST(DebugColours, EveryViewButTheNormalOneHasItsNameInItsLegend) {
  EXPECT_TRUE(legend_of(render::View::kNormal, 8, true).empty());
  for (render::View view = next_view(render::View::kNormal); view != render::View::kNormal;
       view = next_view(view)) {
    const auto legend = legend_of(view, 12, true);
    ASSERT_GE(legend.size(), 2u) << to_string(view);
    EXPECT_EQ(legend[0].text, "view: " + std::string(to_string(view)));
    for (const render::TextLine& line : legend)
      EXPECT_LE(line.text.size(), 40u) << line.text;
    const bool coloured = std::ranges::any_of(
        legend, [](const render::TextLine& line) { return line.swatch.has_value(); });
    EXPECT_EQ(coloured, view != render::View::kWireframe) << to_string(view);
  }
  EXPECT_NE(legend_of(render::View::kWireframe, 8, true)[1].text,
            legend_of(render::View::kWireframe, 8, false)[1].text);
}

TEST(DebugColours, ABoxHasTwelveEdgesAlongTheAxes) {
  std::vector<render::Line> lines;
  add_box({{0, 0, 0}, {1, 2, 3}}, 0xFF8000, lines);
  ASSERT_EQ(lines.size(), 12u);
  float length = 0;
  for (const render::Line& line : lines) {
    const glm::vec3 d = line.to - line.from;
    EXPECT_EQ((d.x != 0) + (d.y != 0) + (d.z != 0), 1);
    length += d.x + d.y + d.z;
  }
  EXPECT_EQ(length, 4 * (1 + 2 + 3));
}

TEST(DebugColours, TheCacheIsShownInSevenStepsOfBytesPerArea) {
  std::set<std::uint32_t> colours;
  for (float bytes = 1.0F / 32; bytes < 1000; bytes *= 2)
    colours.insert(colour_of(render::View::kCache, {.bytes_per_m2 = bytes}));
  EXPECT_EQ(colours.size(), 7u);
  EXPECT_EQ(colour_of(render::View::kCache, {.bytes_per_m2 = 64}),
            colour_of(render::View::kCache, {.bytes_per_m2 = 1e9F}));
}

}  // namespace
}  // namespace psygen::scene
