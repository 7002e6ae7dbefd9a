#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/query/ground_grid.hpp"

namespace psygen::query {
namespace {

struct Step {
  std::int64_t x, z;
  double from, to;
};

std::vector<Step> steps_of(const PlaneLine& line, double side, double from, double to) {
  std::vector<Step> steps;
  march(line, side, from, to, [&](std::int64_t x, std::int64_t z, double a, double b) {
    steps.push_back({x, z, a, b});
    return true;
  });
  return steps;
}

TEST(March, CoversTheWholeLineWithTouchingSquares) {
  core::RandomStream random(3, 0, 0, 0, core::Purpose::kPosition);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec2 from{random.next_real(-50, 50), random.next_real(-50, 50)};
    const glm::dvec2 step{random.next_real(-1, 1), random.next_real(-1, 1)};
    const PlaneLine line(from, step);
    const double side = random.next_real(0.5, 9), end = random.next_real(1, 100);
    const std::vector<Step> steps = steps_of(line, side, 0, end);
    ASSERT_FALSE(steps.empty());
    EXPECT_EQ(steps.front().from, 0);
    EXPECT_EQ(steps.back().to, end);
    for (std::size_t k = 0; k < steps.size(); ++k) {
      const Step& s = steps[k];
      ASSERT_LE(s.from, s.to);
      const glm::dvec2 middle = line.at(0.5 * (s.from + s.to));
      ASSERT_GE(middle.x, static_cast<double>(s.x) * side - 1e-9);
      ASSERT_LE(middle.x, static_cast<double>(s.x + 1) * side + 1e-9);
      ASSERT_GE(middle.y, static_cast<double>(s.z) * side - 1e-9);
      ASSERT_LE(middle.y, static_cast<double>(s.z + 1) * side + 1e-9);
      if (k == 0) continue;
      ASSERT_EQ(s.from, steps[k - 1].to);
      ASSERT_EQ(std::abs(s.x - steps[k - 1].x) + std::abs(s.z - steps[k - 1].z), 1);
    }
  }
}

TEST(March, StaysInOneSquareWithoutAStep) {
  const auto steps = steps_of({{3.5, -2.5}, {0, 0}}, 1, 0, 1e9);
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_EQ(steps[0].x, 3);
  EXPECT_EQ(steps[0].z, -3);
  EXPECT_EQ(steps[0].to, 1e9);
}

TEST(March, FollowsALineOnABorder) {
  for (const double direction : {1.0, -1.0}) {
    const auto steps = steps_of({{4, 0.5}, {0, direction}}, 1, 0, 10);
    EXPECT_EQ(steps.size(), 11U);
    for (const Step& s : steps)
      EXPECT_EQ(s.x, 4);
  }
}

TEST(March, EndsWhenTheVisitorReturnsFalse) {
  int count = 0;
  march({{0, 0}, {1, 0.3}}, 1, 0, 1e9,
        [&](std::int64_t, std::int64_t, double, double) { return ++count < 7; });
  EXPECT_EQ(count, 7);
}

}  // namespace
}  // namespace psygen::query
