#include "engine/scene/draws/missing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace psygen::scene {
namespace {

Camera camera() {
  Camera made;
  made.size = {1000, 500};
  made.pixels_per_radian = 1000;
  return made;
}

// A ball that covers one percent of the picture.
SeenPiece ball() {
  SeenPiece piece;
  piece.centre = {0, 0, -1000};
  piece.radius_m = static_cast<float>(std::sqrt(0.01 * 500'000 / std::numbers::pi));
  return piece;
}

TEST(Missing, WhatIsDrawnAsWantedCountsOnlyAsSeen) {
  Counters counters;
  count_seen(camera(), ball(), counters);
  EXPECT_EQ(counters.nodes_in_view, 1u);
  EXPECT_EQ(counters.holes + counters.coarse + counters.awaited, 0u);
  EXPECT_EQ(counters.missing_pixels_percent, 0);
  EXPECT_EQ(counters.too_coarse_area, 0);
  EXPECT_NEAR(counters.seen_area, 1, 1e-4);
}

TEST(Missing, HolesAndWhatIsTooCoarseLackInThePictureAndAreAwaited) {
  Counters counters;
  SeenPiece hole = ball(), coarse = ball();
  hole.hole = true;
  coarse.coarse = true;
  count_seen(camera(), hole, counters);
  count_seen(camera(), coarse, counters);
  EXPECT_EQ(counters.holes, 1u);
  EXPECT_EQ(counters.coarse, 1u);
  EXPECT_EQ(counters.awaited, 2u);
  EXPECT_NEAR(counters.missing_pixels_percent, 2, 1e-4);
  EXPECT_NEAR(counters.too_coarse_area, 2, 1e-4);
}

TEST(Missing, TwiceTheErrorIsTooCoarseThoughItIsASingleLevel) {
  Counters counters;
  SeenPiece twice = ball();
  twice.twice = true;
  count_seen(camera(), twice, counters);
  count_seen(camera(), ball(), counters);
  EXPECT_EQ(counters.coarse, 0u);
  EXPECT_EQ(counters.missing_pixels_percent, 0);
  EXPECT_EQ(counters.awaited, 1u);
  EXPECT_NEAR(counters.too_coarse_area / counters.seen_area, 0.5, 1e-6);
}

TEST(Missing, WhatCannotBeSynthesisedIsNotAwaited) {
  Counters counters;
  SeenPiece hole = ball();
  hole.hole = true;
  hole.awaits = false;
  count_seen(camera(), hole, counters);
  EXPECT_EQ(counters.holes, 1u);
  EXPECT_EQ(counters.awaited, 0u);
}

}  // namespace
}  // namespace psygen::scene
