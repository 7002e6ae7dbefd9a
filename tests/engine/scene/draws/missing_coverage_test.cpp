#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/scene/draws/draw_lists.hpp"

namespace psygen::scene {
namespace {

Camera camera() {
  Camera made;
  made.size = {1000, 500};
  made.pixels_per_radian = 1000;
  return made;
}

// A ball that covers one percent of the frame.
VisiblePiece ball() {
  VisiblePiece piece;
  piece.centre = {0, 0, -1000};
  piece.radius_m = static_cast<float>(std::sqrt(0.01 * 500'000 / std::numbers::pi));
  return piece;
}

TEST(MissingCoverage, APieceDrawnAsWantedCountsOnlyAsVisible) {
  DrawCounts counts;
  count_visible(camera(), ball(), counts);
  EXPECT_EQ(counts.nodes_in_view, 1u);
  EXPECT_EQ(counts.holes + counts.coarse + counts.awaited, 0u);
  EXPECT_EQ(counts.missing_pixels_percent, 0);
  EXPECT_EQ(counts.too_coarse_area, 0);
  EXPECT_NEAR(counts.seen_area, 1, 1e-4);
}

TEST(MissingCoverage, HolesAndCoarsePiecesAreMissingAndAwaited) {
  DrawCounts counts;
  VisiblePiece hole = ball(), coarse = ball();
  hole.hole = true;
  coarse.coarse = true;
  count_visible(camera(), hole, counts);
  count_visible(camera(), coarse, counts);
  EXPECT_EQ(counts.holes, 1u);
  EXPECT_EQ(counts.coarse, 1u);
  EXPECT_EQ(counts.awaited, 2u);
  EXPECT_NEAR(counts.missing_pixels_percent, 2, 1e-4);
  EXPECT_NEAR(counts.too_coarse_area, 2, 1e-4);
}

TEST(MissingCoverage, TwiceTheErrorIsTooCoarseEvenAtASingleLevel) {
  DrawCounts counts;
  VisiblePiece twice = ball();
  twice.twice = true;
  count_visible(camera(), twice, counts);
  count_visible(camera(), ball(), counts);
  EXPECT_EQ(counts.coarse, 0u);
  EXPECT_EQ(counts.missing_pixels_percent, 0);
  EXPECT_EQ(counts.awaited, 1u);
  EXPECT_NEAR(counts.too_coarse_area / counts.seen_area, 0.5, 1e-6);
}

TEST(MissingCoverage, AFailedMeshIsNotAwaited) {
  DrawCounts counts;
  VisiblePiece hole = ball();
  hole.hole = true;
  hole.awaits = false;
  count_visible(camera(), hole, counts);
  EXPECT_EQ(counts.holes, 1u);
  EXPECT_EQ(counts.awaited, 0u);
}

}  // namespace
}  // namespace psygen::scene
