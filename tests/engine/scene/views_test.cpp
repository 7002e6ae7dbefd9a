#include "engine/scene/views.hpp"

#include <gtest/gtest.h>

#include <set>

namespace psygen::scene {
namespace {

using render::View;

TEST(Views, EveryLevelUpToTheEighthHasAColourOfItsOwn) {
  std::set<std::uint32_t> colours;
  for (std::uint32_t level = 0; level < 8; ++level)
    colours.insert(colour_of(View::kLevels, {.level = level}));
  EXPECT_EQ(colours.size(), 8u);
}

TEST(Views, LayersGetDarkerAndStayColours) {
  std::uint32_t last = 256;
  for (std::uint32_t layer = 0; layer < 15; ++layer) {
    const std::uint32_t red = colour_of(View::kLayers, {.layer = layer}) >> 16;
    EXPECT_LT(red, last);
    last = red;
  }
  EXPECT_LE(colour_of(View::kLayers, {.layer = 60'000}), 0xFFFFFFu);
}

TEST(Views, WhatIsMissingStandsOut) {
  const std::uint32_t fine = colour_of(View::kMissing, {.coarser = 0});
  const std::uint32_t nearly = colour_of(View::kMissing, {.coarser = 1});
  EXPECT_NE(fine, nearly);
  EXPECT_NE(nearly, colour_of(View::kMissing, {.coarser = 2}));
  EXPECT_EQ(colour_of(View::kMissing, {.coarser = 2}), colour_of(View::kMissing, {.coarser = 5}));
}

TEST(Views, ABoxHasTwelveEdgesAlongTheAxes) {
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

TEST(Views, TheCacheIsShownInSevenStepsOfBytesPerArea) {
  std::set<std::uint32_t> colours;
  for (float bytes = 1.0F / 32; bytes < 1000; bytes *= 2)
    colours.insert(colour_of(View::kCache, {.bytes_per_m2 = bytes}));
  EXPECT_EQ(colours.size(), 7u);
  EXPECT_EQ(colour_of(View::kCache, {.bytes_per_m2 = 64}),
            colour_of(View::kCache, {.bytes_per_m2 = 1e9F}));
}

}  // namespace
}  // namespace psygen::scene
