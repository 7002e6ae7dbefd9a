#include "engine/scene/facts/solidity.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <vector>

#include "tests/engine/visibility/scenes.hpp"

namespace psygen::scene {
namespace {

using visibility::testing::stream;

TEST(EstimateSolidity, AnEmptyCellBlocksNoLight) {
  EXPECT_EQ(estimate_solidity(64, 0, {}, 10), 0);
  EXPECT_EQ(estimate_solidity(64, 0, std::vector<Standing>{{0, 3, 5, 1}, {9, 3, 5, 0}}, 10), 0);
}

TEST(EstimateSolidity, GroundBlocksTheFractionOfTheBandThatItFillsOnAverage) {
  EXPECT_NEAR(estimate_solidity(64, 10, {}, 20), 0.25F, 1e-6F);
  EXPECT_NEAR(estimate_solidity(64, 10, {}, 10), 0.5F, 1e-6F);
  EXPECT_NEAR(estimate_solidity(64, 20, {}, 10), 0.75F, 1e-6F);
}

// The fraction of random straight rays through a square that hit one of `count` discs in it.
double share_met(int count, double width, double side, core::RandomStream& random) {
  int met = 0, rays = 0;
  while (rays < 20'000) {
    const double turn = random.next_real(0, 6.28318), aside = random.next_real(-side, side);
    const glm::dvec2 along(std::cos(turn), std::sin(turn)), normal(-along.y, along.x);
    // Interval of the ray inside the square [−side/2, side/2]².
    double from = -1e9, to = 1e9;
    for (int axis = 0; axis < 2; ++axis) {
      const double a = (-side / 2 - aside * normal[axis]) / along[axis],
                   b = (side / 2 - aside * normal[axis]) / along[axis];
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
    }
    if (from >= to) continue;
    ++rays;
    for (int i = 0; i < count; ++i) {
      const glm::dvec2 disc{random.next_real(-side / 2, side / 2),
                            random.next_real(-side / 2, side / 2)};
      const double at = glm::dot(disc, along);
      if (std::abs(glm::dot(disc, normal) - aside) < width / 2 && at > from && at < to) {
        ++met;
        break;
      }
    }
  }
  return static_cast<double>(met) / rays;
}

TEST(EstimateSolidity, OfObjectsEqualsTheFractionOfRandomRaysThatHitOne) {
  core::RandomStream random = stream(67, 0);
  for (const auto& [count, width] : {std::pair{10, 1.0}, {10, 4.0}, {40, 2.0}, {80, 3.0}}) {
    const std::vector<Standing> things{
        {static_cast<float>(count), static_cast<float>(width), 8, 1}};
    const float estimated = estimate_solidity(64, 0, things, 8);
    const double met = share_met(count, width, 64, random);
    // Rays have different lengths: they block somewhat less than the same number of mean rays.
    EXPECT_GT(estimated, met - 0.01) << count << " of " << width << " m";
    EXPECT_LT(estimated, met + 0.11) << count << " of " << width << " m";
    EXPECT_NEAR(estimate_solidity(64, 0, things, 32), estimated / 4, 1e-6F);
  }
}

TEST(EstimateSolidity, StaysInRangeAndNeverShrinksAsTheCellFills) {
  core::RandomStream random = stream(67, 1);
  const auto value = [&random](double high) {
    return static_cast<float>(random.next_real(0, high));
  };
  for (int i = 0; i < 500; ++i) {
    const float side = 1 + value(500), relief = value(100), band = 0.1F + value(200);
    const std::vector<Standing> things{{value(500), value(10), value(40), value(1)},
                                       {value(50), value(3), value(9), value(1)}};
    const float solidity = estimate_solidity(side, relief, things, band);
    EXPECT_GE(solidity, 0);
    EXPECT_LE(solidity, 1);
    const float slack = 1e-6F;
    EXPECT_GE(estimate_solidity(side, relief * 1.5F, things, band), solidity - slack);
    EXPECT_LE(estimate_solidity(side * 1.5F, relief, things, band), solidity + slack);
    EXPECT_LE(estimate_solidity(side, relief, things, band * 1.5F), solidity + slack);
    for (float Standing::*member :
         {&Standing::count, &Standing::width_m, &Standing::height_m, &Standing::density}) {
      std::vector<Standing> more = things;
      more[0].*member *= 1.5F;
      EXPECT_GE(estimate_solidity(side, relief, more, band), solidity - slack);
    }
  }
}

}  // namespace
}  // namespace psygen::scene
