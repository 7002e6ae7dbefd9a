#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "engine/visibility/quadtree.hpp"

namespace psygen::visibility {
namespace {

constexpr std::array kErrors{0.0F, 0.1F, 0.4F, 1.6F};
constexpr float kPixelsPerRadian = 745;
constexpr float kPixels = 2;

float error_pixels(std::size_t level, float distance_m) {
  return kErrors[level] * kPixelsPerRadian / distance_m;
}

int choose(float distance_m, int current = -1, float pixels = kPixels) {
  return choose_level(kErrors, distance_m, kPixelsPerRadian, pixels, current);
}

TEST(LevelChoice, OnlyTheErrorOfTheNextLevelWouldExceedTheAllowedPixels) {
  for (float distance = 0.5F; distance < 3000; distance *= 1.03F) {
    const auto level = static_cast<std::size_t>(choose(distance));
    EXPECT_LE(error_pixels(level, distance), kPixels * 1.001F);
    if (level + 1 == kErrors.size()) continue;
    EXPECT_GT(error_pixels(level + 1, distance), kPixels * 0.999F);
  }
}

TEST(LevelChoice, LevelsGrowWithDistanceAndWithTheAllowedError) {
  for (const int current : {-1, 0, 2, 3}) {
    int last = 0;
    for (float distance = 0.1F; distance < 5000; distance *= 1.01F) {
      const int level = choose(distance, current);
      EXPECT_GE(level, last);
      last = level;
    }
    EXPECT_EQ(last, 3);
    last = 0;
    for (float pixels = 0.01F; pixels < 100; pixels *= 1.05F) {
      const int level = choose(200, current, pixels);
      EXPECT_GE(level, last);
      last = level;
    }
  }
}

TEST(LevelChoice, TheShownLevelStaysOnTheBorderOfTwoLevels) {
  // Level 2 is allowed from 149 m on, and chosen from 186.25 m on.
  EXPECT_EQ(choose(150), 2);
  EXPECT_EQ(choose(150, 1), 1);
  EXPECT_EQ(choose(185, 1), 1);
  EXPECT_EQ(choose(187, 1), 2);
  EXPECT_EQ(choose(150, 2), 2);
  EXPECT_EQ(choose(148, 2), 1);
}

TEST(LevelChoice, OscillationAroundABorderChangesTheLevelOnce) {
  int level = choose(140), changes = 0;
  for (int i = 0; i < 100; ++i) {
    const int next = choose(i % 2 == 0 ? 147.0F : 152.0F, level);
    changes += next != level ? 1 : 0;
    level = next;
  }
  EXPECT_LE(changes, 1);
}

TEST(LevelChoice, InsideAMeshOrAtAnInvalidDistanceTheFinestLevelIsChosen) {
  EXPECT_EQ(choose(0), 0);
  EXPECT_EQ(choose(-5, 3), 0);
  EXPECT_EQ(choose(std::numeric_limits<float>::quiet_NaN()), 0);
}

TEST(LevelChoice, AMeshOfOneLevelOrOfNoneHasLevelZero) {
  EXPECT_EQ(choose_level(std::array{0.0F}, 1e6F, kPixelsPerRadian, kPixels, -1), 0);
  EXPECT_EQ(choose_level({}, 1e6F, kPixelsPerRadian, kPixels, -1), 0);
}

}  // namespace
}  // namespace psygen::visibility
