#include "engine/render/textures/ground_textures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <span>

#include "shaders/shared.h"

namespace psygen::render {
namespace {

constexpr std::size_t kTexels = std::size_t{kPatternSide} * kPatternSide;

int channel(const GroundLevels& levels, std::size_t layer, int x, int y, std::size_t c) {
  return levels[0][(layer * kTexels + static_cast<std::size_t>(y * kPatternSide + x)) * 4 + c];
}

double mean(const GroundLevels& levels, std::size_t level, std::size_t layer, std::size_t c) {
  const std::size_t texels = kTexels >> (2 * level);
  double sum = 0;
  for (std::size_t i = 0; i < texels; ++i)
    sum += levels[level][(layer * texels + i) * 4 + c];
  return sum / static_cast<double>(texels);
}

TEST(GroundTextures, ColoursHaveAMeanOfOneAtEveryLevelSoThatDistanceChangesNoColour) {
  const GroundLevels layers = make_ground_layers(), detail = make_ground_detail();
  ASSERT_EQ(layers.size(), 9U);
  ASSERT_EQ(detail.size(), 9U);
  for (std::size_t level = 0; level < layers.size(); ++level) {
    for (std::size_t c = 0; c < 4; ++c)
      EXPECT_NEAR(mean(detail, level, 0, c), 127.5, 1.6) << level;
    for (std::size_t c = 1; c < 4; ++c)  // 0 is a height
      EXPECT_NEAR(mean(detail, level, 1, c), 127.5, 1.6) << level;
    for (std::size_t layer = 0; layer < kGroundTextures; ++layer) {
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(mean(layers, level, layer, c), 127.5, 1.6) << level << ' ' << layer;
    }
  }
}

TEST(GroundTextures, RepeatWithoutASeam) {
  const GroundLevels layers = make_ground_layers();
  for (std::size_t layer = 0; layer < kGroundLayers; ++layer) {
    std::array<int, kPatternSide> across{}, down{};  // differences from the texels before
    for (int at = 0; at < kPatternSide; ++at) {
      const int before = (at + kPatternSide - 1) % kPatternSide;
      for (int i = 0; i < kPatternSide; ++i) {
        const auto k = static_cast<std::size_t>(at);
        across[k] +=
            std::abs(channel(layers, layer, at, i, 0) - channel(layers, layer, before, i, 0));
        down[k] +=
            std::abs(channel(layers, layer, i, at, 0) - channel(layers, layer, i, before, 0));
      }
    }
    for (const auto& steps : {across, down})
      EXPECT_LE(steps[0], *std::max_element(steps.begin() + 1, steps.end()) + kPatternSide)
          << layer;
  }
}

TEST(GroundTextures, KindsDifferInContrastAndSnowHasTheLeast) {
  const GroundLevels layers = make_ground_layers();
  const auto contrast = [&](std::size_t layer) {
    double sum = 0;
    for (int y = 0; y < kPatternSide; ++y) {
      for (int x = 0; x < kPatternSide; ++x)
        sum += std::abs(channel(layers, layer, x, y, 1) - 127.5);
    }
    return sum / static_cast<double>(kTexels);
  };
  for (const std::size_t kind : {0U, 1U, 2U, 4U, 6U}) {
    EXPECT_GT(contrast(kind), 10.0) << kind;
    EXPECT_LT(contrast(5), contrast(kind)) << kind;
  }
}

TEST(GroundTextures, NormalsPointUpOnAverageAndHaveRelief) {
  const GroundLevels layers = make_ground_layers();
  for (std::size_t layer = kGroundTextures; layer < kGroundLayers; ++layer) {
    int steep = 0;
    for (int y = 0; y < kPatternSide; ++y) {
      for (int x = 0; x < kPatternSide; ++x)
        steep += std::abs(channel(layers, layer, x, y, 0) - 127) > 12 ? 1 : 0;
    }
    EXPECT_NEAR(mean(layers, 0, layer, 0), 127.5, 3.0) << layer;
    EXPECT_NEAR(mean(layers, 0, layer, 1), 127.5, 3.0) << layer;
    EXPECT_GT(steep, 100) << layer;
  }
}

TEST(GroundTextures, APictureTakesThePlaceOfItsKindAndOfNoOther) {
  std::vector<GroundPicture> pictures(kGroundPictures);
  pictures[2].rgb.resize(kTexels * 3, 0.1F);
  for (std::size_t i = 0; i < kTexels; i += 2)
    pictures[2].rgb[i * 3] = 0.3F;
  const GroundLevels with = make_ground_layers(pictures), without = make_ground_layers();
  for (std::size_t layer = 0; layer < kGroundLayers; ++layer) {
    bool same = true;
    for (std::size_t i = layer * kTexels * 4; i < (layer + 1) * kTexels * 4; ++i)
      same = same && with[0][i] == without[0][i];
    EXPECT_EQ(same, layer % kGroundTextures != 2) << layer;
  }
  EXPECT_EQ(channel(with, 2, 0, 0, 0), 191) << "3 of 2 in the mean";
  EXPECT_EQ(channel(with, 2, 1, 0, 0), 64);
  EXPECT_EQ(channel(with, 2, 0, 0, 1), 128) << "even in green";
  EXPECT_EQ(make_ground_detail(pictures), make_ground_detail()) << "which has no dry grass";
}

TEST(GroundTextures, ModelsHaveBarkAndLeavesOfTheirOwnAndStoneOfThePictureOfRock) {
  const GroundLevels layers = make_ground_layers(), detail = make_ground_detail();
  // The order of channels that model_detail.frag has.
  const auto likeness = [&](std::size_t c, std::size_t texture, std::size_t of) {
    double sum = 0;
    for (int y = 0; y < kPatternSide; ++y) {
      for (int x = 0; x < kPatternSide; ++x)
        sum += (channel(detail, 1, x, y, c) - 127.5) * (channel(layers, texture, x, y, of) - 127.5);
    }
    return sum;
  };
  for (const std::size_t other : std::array<std::size_t, 3>{
           PSYGEN_TEXTURE_ROCK, PSYGEN_TEXTURE_BARK, PSYGEN_TEXTURE_LEAVES}) {
    EXPECT_GE(likeness(1, PSYGEN_TEXTURE_BARK, 1), likeness(1, other, 1));
    EXPECT_GE(likeness(2, PSYGEN_TEXTURE_ROCK, 1), likeness(2, other, 1));
    EXPECT_GE(likeness(3, PSYGEN_TEXTURE_LEAVES, 1), likeness(3, other, 1));
  }
  EXPECT_GT(likeness(0, PSYGEN_TEXTURE_LEAVES, 3),
            2 * std::abs(likeness(0, PSYGEN_TEXTURE_BARK, 3)));
  std::vector<GroundPicture> pictures(kGroundPictures);
  for (GroundPicture& picture : pictures)
    picture.rgb.resize(kTexels * 3, 0.1F);
  const GroundLevels with = make_ground_detail(pictures);
  for (int i = 0; i < kPatternSide; ++i) {
    for (const int c : {0, 1, 3})
      EXPECT_EQ(channel(with, 1, i, 9, c), channel(detail, 1, i, 9, c));
    EXPECT_EQ(channel(with, 1, i, 9, 2), 128);
  }
}

TEST(GroundTextures, AreTheSameEachTime) {
  EXPECT_EQ(make_ground_detail(), make_ground_detail());
}

TEST(GroundPatterns, AStrokeCoversLowerTexelsAndContinuesBeyondTheBorder) {
  Field height, tone;
  height.at(4, 8) = 2.0F;
  draw_stroke({250, 8, 20, 0, 3, 0.5F, 0.5F, 0.7F}, height, tone);
  EXPECT_EQ(height.at(252, 8), 0.5F);
  EXPECT_EQ(tone.at(252, 8), 0.7F);
  EXPECT_EQ(tone.at(2, 8), 0.7F) << "beyond the border";
  EXPECT_EQ(height.at(4, 8), 2.0F) << "something higher";
  EXPECT_EQ(tone.at(4, 8), 0.0F);
  EXPECT_EQ(height.at(252, 20), 0.0F);
}

TEST(GroundPatterns, RaisedTexelsAreAboveTheMeanOfTheirSurroundings) {
  Field height;
  height.at(0, 0) = 1.0F;
  const Field above = raised(height, 1);
  EXPECT_NEAR(above.at(0, 0), 8.0F / 9, 1e-5F);
  EXPECT_NEAR(above.at(-1, -1), -1.0F / 9, 1e-5F);
  EXPECT_NEAR(above.at(2, 0), 0.0F, 1e-5F);
}

}  // namespace
}  // namespace psygen::render
