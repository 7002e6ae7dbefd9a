#include "engine/query/ground_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "engine/core/hash.hpp"
#include "tests/engine/query/triangles.hpp"

namespace psygen::query {
namespace {

using testing::crosses;

// Random heights, 0 … 20 m, over 22 x 22 vertices 1.5 m apart.
constexpr int kSize = 22;
constexpr double kCell = 1.5, kRelief = 20, kEnd = (kSize - 1) * kCell;

GroundGrid rough(std::uint64_t seed) {
  core::RandomStream random(seed, 0, 0, 0, core::Purpose::kStructure);
  std::vector<std::uint16_t> heights(kSize * kSize);
  for (std::uint16_t& h : heights)
    h = static_cast<std::uint16_t>(random.next_integer(0, 65535));
  return {std::move(heights), kCell, kRelief};
}

GroundRay ray_of(const glm::dvec3& from, const glm::dvec3& direction) {
  return {{{from.x, from.z}, {direction.x, direction.z}}, from.y, direction.y};
}

double first_crossing(const GroundGrid& grid, const glm::dvec3& from, const glm::dvec3& d) {
  const auto vertex = [&](int x, int z) {
    return glm::dvec3(
        x * kCell, grid.metres(grid.heights()[static_cast<std::size_t>(z * kSize + x)]), z * kCell);
  };
  double first = 1e9;
  for (int z = 0; z + 1 < kSize; ++z) {
    for (int x = 0; x + 1 < kSize; ++x) {
      for (const double t :
           {crosses(from, d, vertex(x, z), vertex(x + 1, z), vertex(x, z + 1)),
            crosses(from, d, vertex(x + 1, z + 1), vertex(x + 1, z), vertex(x, z + 1))})
        if (t >= 0) first = std::min(first, t);
    }
  }
  return first;
}

TEST(GroundGrid, RaysHitTheFirstOfAllTriangles) {
  const GroundGrid grid = rough(1);
  core::RandomStream random(2, 0, 0, 0, core::Purpose::kPosition);
  const auto r = [&](double low, double high) { return random.next_real(low, high); };
  int hits = 0, from_below = 0;
  for (int i = 0; i < 4000; ++i) {
    const glm::dvec3 from(r(0, kEnd), r(-10, 40), r(0, kEnd)),
        to(r(0, kEnd), r(-10, 30), r(0, kEnd));
    const double length = glm::length(to - from);
    const glm::dvec3 d = (to - from) / length;
    Side side = Side::kUnknown;
    const auto hit = grid.cast(ray_of(from, d), 0, length, side);
    const double expected = first_crossing(grid, from, d);
    ASSERT_EQ(hit.has_value(), expected <= length) << i;
    if (!hit) continue;
    ++hits;
    from_below += hit->from_below;
    ASSERT_NEAR(hit->t, expected, 1e-9);
    ASSERT_EQ(hit->from_below, glm::dot(glm::dvec3(hit->normal), d) > 0);
    ASSERT_GT(hit->normal.y, 0);
  }
  EXPECT_GT(hits, 1000);
  EXPECT_GT(from_below, 200);
}

TEST(GroundGrid, VerticalRaysHitTheHeightOfThePoint) {
  const GroundGrid grid = rough(3);
  core::RandomStream random(4, 0, 0, 0, core::Purpose::kPosition);
  for (int i = 0; i < 500; ++i) {
    // Also exactly on vertices, edges and diagonals.
    const double step = i % 2 == 0 ? 1.5 : 0.75;
    const glm::dvec2 at =
        i % 4 < 2 ? glm::dvec2{random.next_real(0, kEnd), random.next_real(0, kEnd)}
                  : step * glm::dvec2{random.next_integer(0, 20), random.next_integer(0, 20)};
    const models::GroundPoint ground = grid.at(at);
    Side side = Side::kUnknown;
    const auto down = grid.cast(ray_of({at.x, 100, at.y}, {0, -1, 0}), 0, 1e9, side);
    ASSERT_TRUE(down);
    EXPECT_NEAR(down->t, 100 - ground.height_m, 1e-9);
    side = Side::kUnknown;
    const auto up = grid.cast(ray_of({at.x, -5, at.y}, {0, 1, 0}), 0, 1e9, side);
    ASSERT_TRUE(up);
    EXPECT_TRUE(up->from_below);
    EXPECT_NEAR(up->t, 5 + ground.height_m, 1e-9);
  }
}

TEST(GroundGrid, NoRayPassesBetweenTwoTriangles) {
  const GroundGrid grid = rough(5);
  // Aimed exactly at vertices and middles of edges, from exact and from inexact positions.
  core::RandomStream random(6, 0, 0, 0, core::Purpose::kPosition);
  for (int i = 0; i < 5000; ++i) {
    const glm::dvec2 at = 0.75 * glm::dvec2{random.next_integer(2, 40), random.next_integer(2, 40)};
    const glm::dvec3 target(at.x, grid.at(at).height_m - 1e-3, at.y);
    const glm::dvec3 from =
        i % 2 == 0 ? glm::dvec3{1.5 * static_cast<double>(random.next_integer(0, 21)), 45,
                                1.5 * static_cast<double>(random.next_integer(0, 21))}
                   : glm::dvec3{random.next_real(0, kEnd), 45, random.next_real(0, kEnd)};
    const double length = glm::length(target - from);
    Side side = Side::kUnknown;
    const auto hit = grid.cast(ray_of(from, (target - from) / length), 0, length, side);
    ASSERT_TRUE(hit.has_value()) << i;
    ASSERT_FALSE(hit->from_below);
  }
}

TEST(GroundGrid, ARayThatBeginsOnTheGroundHitsItUnlessItRises) {
  const GroundGrid grid = rough(7);
  core::RandomStream random(8, 0, 0, 0, core::Purpose::kPosition);
  for (int i = 0; i < 500; ++i) {
    const glm::dvec2 at{random.next_real(1, kEnd - 1), random.next_real(1, kEnd - 1)};
    const models::GroundPoint ground = grid.at(at);
    const glm::dvec3 from(at.x, ground.height_m, at.y);
    Side side = Side::kUnknown;
    const auto down = grid.cast(ray_of(from, {0, -1, 0}), 0, 100, side);
    ASSERT_TRUE(down);
    EXPECT_EQ(down->t, 0);
    EXPECT_FALSE(down->from_below);
    side = Side::kUnknown;
    EXPECT_FALSE(grid.cast(ray_of(from, {0, 1, 0}), 0, 100, side));
    side = Side::kUnknown;
    const auto away = grid.cast(ray_of(from, glm::dvec3(ground.normal)), 0, 0.05, side);
    EXPECT_TRUE(!away || away->t > 0);  // it may hit another triangle that faces this one
  }
}

TEST(GroundGrid, ARayAlongFlatGroundHitsItAtItsOrigin) {
  const GroundGrid flat(std::vector<std::uint16_t>(kSize * kSize, 30000), kCell, kRelief);
  const double height = flat.metres(30000);
  Side side = Side::kUnknown;
  const auto hit = flat.cast(ray_of({5, height, 7}, {1, 0, 0}), 0, 20, side);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->t, 0);
  side = Side::kUnknown;
  EXPECT_FALSE(flat.cast(ray_of({5, height + 1e-3, 7}, {1, 0, 0}), 0, 20, side));
  EXPECT_EQ(side, Side::kAbove);
  side = Side::kUnknown;
  EXPECT_FALSE(flat.cast(ray_of({5, height - 1e-3, 7}, {1, 0, 0}), 0, 20, side));
  EXPECT_EQ(side, Side::kBelow);
}

TEST(GroundGrid, PointsOutsideAreMovedToTheBorder) {
  const GroundGrid grid = rough(9);
  EXPECT_EQ(grid.at({-5, 3}).height_m, grid.at({0, 3}).height_m);
  EXPECT_EQ(grid.at({kEnd + 5, kEnd + 7}).height_m, grid.at({kEnd, kEnd}).height_m);
}

}  // namespace
}  // namespace psygen::query
