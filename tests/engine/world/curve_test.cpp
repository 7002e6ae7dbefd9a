// Curves through points: where they pass, how they count, and where lines cross themselves.
#include "engine/world/curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace psygen::world {
namespace {

const std::vector<glm::dvec2> kPoints{{0, 0}, {100, 10}, {130, 90}, {131, 90}, {40, 200}};

TEST(Curve, PassesThroughItsPointsAndCountsThem) {
  const std::vector<CurvePoint> curve = curve_through(kPoints, 7);
  std::size_t passed = 0;
  for (std::size_t i = 0; i < curve.size(); ++i) {
    EXPECT_GE(curve[i].share, 0);
    EXPECT_LT(curve[i].share, 1);
    if (curve[i].share == 0) {
      EXPECT_EQ(curve[i].after, passed);
      EXPECT_EQ(curve[i].at_m, kPoints[passed]);
      ++passed;
    } else {
      EXPECT_EQ(curve[i].after, passed - 1);
    }
    if (i == 0) continue;
    const double step_m = length_of(curve[i].at_m - curve[i - 1].at_m);
    EXPECT_GT(step_m, 0.5);
    EXPECT_LT(step_m, 2.0 * 7) << "the curve is longer than its chords";
    EXPECT_DOUBLE_EQ(curve[i].along_m, curve[i - 1].along_m + step_m);
  }
  EXPECT_EQ(passed, kPoints.size());
  EXPECT_GT(curve.back().along_m, chords_m(kPoints));
}

TEST(Curve, HasNoPointTwiceWherePointsAreNear) {
  const std::vector<CurvePoint> curve = curve_through(std::vector<glm::dvec2>{{0, 0}, {1, 0}}, 7);
  ASSERT_EQ(curve.size(), 2U);
  EXPECT_EQ(curve[1].after, 1U);
  EXPECT_DOUBLE_EQ(curve[1].along_m, 1);
}

TEST(Curve, ChordsAreStraightLines) {
  EXPECT_DOUBLE_EQ(chords_m(std::vector<glm::dvec2>{{1, 1}, {4, 5}, {4, -5}}), 15);
  EXPECT_EQ(chords_m(std::vector<glm::dvec2>{{1, 1}}), 0);
  EXPECT_EQ(chords_m({}), 0);
}

// A circle through eight points has no corner at any of them, where it closes neither.
TEST(Curve, ClosesSmoothly) {
  constexpr double kRadiusM = 100, kEighth = 0.7853981633974483;
  std::vector<glm::dvec2> points;
  for (int i = 0; i < 8; ++i)
    points.push_back(kRadiusM * glm::dvec2(std::cos(i * kEighth), std::sin(i * kEighth)));
  const std::vector<glm::dvec2> curve = closed_curve_through(points, 5);
  ASSERT_GT(curve.size(), 100U);
  for (std::size_t i = 0; i < curve.size(); ++i) {
    EXPECT_NEAR(length_of(curve[i]), kRadiusM, 0.3) << i;
    const glm::dvec2 before = curve[i] - curve[(i + curve.size() - 1) % curve.size()];
    const glm::dvec2 after = curve[(i + 1) % curve.size()] - curve[i];
    const double turn =
        (before.x * after.y - before.y * after.x) / (length_of(before) * length_of(after));
    EXPECT_NEAR(turn, length_of(before) / kRadiusM, 0.02) << i;
  }
}

TEST(Curve, FindsWhereALineCrossesItself) {
  std::vector<glm::dvec2> zigzag;
  for (int i = 0; i < 100; ++i)
    zigzag.emplace_back(i, i % 2 * 5);
  EXPECT_FALSE(self_crossing(zigzag, false));
  EXPECT_TRUE(self_crossing(zigzag, true)) << "the last segment leads back through the others";
  zigzag.emplace_back(99, 20);
  zigzag.emplace_back(50.5, 20);
  EXPECT_FALSE(self_crossing(zigzag, false));
  zigzag.emplace_back(50.5, 2);
  const auto at = self_crossing(zigzag, false);
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->x, 50.5, 0.01);
}

}  // namespace
}  // namespace psygen::world
