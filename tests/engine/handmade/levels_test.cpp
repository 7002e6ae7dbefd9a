#include "engine/handmade/levels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "engine/gltf/read_file.hpp"
#include "tests/engine/handmade/shapes.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::handmade {
namespace {

TEST(Levels, HaveAQuarterOfTheTrianglesEachAndGrowingErrors) {
  const std::vector<Level> levels = levels_of(sphere(64, 128), 5);
  ASSERT_EQ(levels.size(), 5U);
  EXPECT_EQ(levels[0].error_m, 0);
  for (std::size_t i = 1; i < levels.size(); ++i) {
    const double before = static_cast<double>(levels[i - 1].indices.size());
    EXPECT_LT(static_cast<double>(levels[i].indices.size()), 0.4 * before) << i;
    EXPECT_GT(levels[i].error_m, levels[i - 1].error_m) << i;
  }
  EXPECT_LT(levels[3].error_m, 0.5);
}

// Every point of a coarse level is within its error of the sphere.
TEST(Levels, HaveErrorsThatBoundTheDistance) {
  for (const Level& level : levels_of(sphere(64, 128), 4)) {
    for (std::size_t i = 0; i < level.indices.size(); i += 3) {
      glm::vec3 middle(0.0F);
      for (std::size_t k = 0; k < 3; ++k)
        middle += level.vertices[level.indices[i + k]].position * (1.0F / 3);
      EXPECT_LT(1 - glm::length(middle), 3 * level.error_m + 0.003);
    }
  }
}

TEST(Levels, KeepColoursApartAndNormalsOutwards) {
  for (const Level& level : levels_of(sphere(64, 128), 3)) {
    for (const Vertex& v : level.vertices) {
      EXPECT_EQ(v.colour[0], 200);
      EXPECT_EQ(v.colour[1] % 64, 0);
      EXPECT_GT(glm::dot(v.normal, v.position), 0.8F);
      EXPECT_NEAR(glm::length(v.normal), 1, 1e-5F);
    }
  }
}

TEST(Levels, NeverHaveMoreVerticesThanAnIndexCanName) {
  const std::vector<Level> levels = levels_of(sphere(400, 500), 3);
  ASSERT_EQ(levels.size(), 3U);
  EXPECT_LE(levels[0].vertices.size(), 65'536U);
  EXPECT_GT(levels[0].vertices.size(), 20'000U);
}

TEST(Levels, EndWhenNothingIsLeftToMerge) {
  Triangles one;
  one.vertices = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}};
  one.indices = {0, 1, 2};
  EXPECT_EQ(levels_of(one, 8).size(), 1U);
  one.indices = {0, 1, 1};
  EXPECT_TRUE(levels_of(one, 8).empty());
  // Loose triangles: only the sloppy simplifier finds coarser levels.
  Triangles cards;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const glm::vec3 at(i % 10, i / 10 % 20, i / 200);
    for (const glm::vec3& corner : {glm::vec3(0), glm::vec3(0.5F, 0, 0), glm::vec3(0, 0.5F, 0)}) {
      cards.indices.push_back(static_cast<std::uint32_t>(cards.vertices.size()));
      cards.vertices.push_back({at + corner});
    }
  }
  const std::vector<Level> levels = levels_of(cards, 4);
  ASSERT_GE(levels.size(), 2U);
  EXPECT_LT(levels[1].indices.size(), cards.indices.size() / 2);
}

TEST(Levels, AreTheSameEveryTime) {
  const std::vector<Level> a = levels_of(sphere(40, 60), 4), b = levels_of(sphere(40, 60), 4);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].indices, b[i].indices);
    EXPECT_EQ(a[i].error_m, b[i].error_m);
  }
}

// The area of the triangles of leaves, or of all other triangles.
double area_in(const Level& level, bool leaves) {
  double area = 0;
  for (std::size_t i = 0; i < level.indices.size(); i += 3) {
    const auto at = [&](std::size_t k) -> const Vertex& {
      return level.vertices[level.indices[i + k]];
    };
    if ((at(0).leaf != 0) == leaves)
      area += static_cast<double>(glm::length(
                  glm::cross(at(1).position - at(0).position, at(2).position - at(0).position))) /
              2;
  }
  return area;
}

// Loose leaves cannot be merged: coarser levels have fewer and larger ones.
TEST(Levels, OfATreeOfCardsKeepItsTrunkAndTheAreaOfItsLeaves) {
  const TemporaryFolder folder;
  write_card_tree(folder / "tree.glb");
  const Triangles t = triangles_of(gltf::read_file(folder / "tree.glb").value(), {}).value();
  const std::vector<Level> levels = levels_of(t, 8);
  ASSERT_GE(levels.size(), 4U);
  const double leaves = area_in(levels[0], true), trunk = area_in(levels[0], false);
  for (std::size_t i = 1; i < levels.size(); ++i) {
    EXPECT_LT(levels[i].indices.size(), levels[i - 1].indices.size());
    EXPECT_GT(levels[i].error_m, levels[i - 1].error_m);
    EXPECT_GT(area_in(levels[i], false), trunk / 2) << i;
    EXPECT_LT(area_in(levels[i], true), 1.01 * leaves) << i;
    if (levels[i].indices.size() > 3 * 300) {
      EXPECT_NEAR(area_in(levels[i], true), leaves, 0.05 * leaves) << i;
    }
    for (const Vertex& v : levels[i].vertices)
      EXPECT_LT(glm::length(v.position - glm::vec3(0, 5, 0)), 7) << i;
  }
}

// A point of a level of a wall.
struct Seen {
  glm::vec3 colour{0.0F}, normal{0.0F};  // colour: 0 … 1
};

// Points of a level at the middles of `side` · `side` squares of a wall, row by row.
std::vector<Seen> seen_on_wall(const Level& level, int side) {
  std::vector<Seen> seen(static_cast<std::size_t>(side * side));
  std::vector<bool> found(seen.size());
  const auto cross = [](glm::vec2 u, glm::vec2 v) { return u.x * v.y - u.y * v.x; };
  for (std::size_t t = 0; t < level.indices.size(); t += 3) {
    const Vertex* v[3];
    for (std::size_t k = 0; k < 3; ++k)
      v[k] = &level.vertices[level.indices[t + k]];
    const glm::vec2 a(v[0]->position), b(v[1]->position), c(v[2]->position);
    const float step = 3.0F / static_cast<float>(side);
    const glm::ivec2 low(glm::max(glm::min(a, glm::min(b, c)) / step - 1.0F, 0.0F));
    const glm::ivec2 high(glm::max(a, glm::max(b, c)) / step);
    const int wide = std::min(high.x, side - 1) - low.x + 1;
    for (int n = 0; n < wide * (std::min(high.y, side - 1) - low.y + 1); ++n) {
      const glm::ivec2 at = low + glm::ivec2(n % wide, n / wide);
      const auto i = static_cast<std::size_t>(at.y * side + at.x);
      const glm::vec2 p = step * (glm::vec2(at) + 0.5F);
      const glm::vec3 w = glm::vec3(cross(c - b, p - b), cross(a - c, p - c), cross(b - a, p - a)) /
                          cross(b - a, c - a);
      if (std::min({w.x, w.y, w.z}) < -1e-4F) continue;
      found[i] = true;
      seen[i] = {};
      for (int k = 0; k < 3; ++k) {
        seen[i].colour += w[k] / 255 * glm::vec3(v[k]->colour[0], v[k]->colour[1], v[k]->colour[2]);
        seen[i].normal += w[k] * v[k]->normal;
      }
    }
  }
  EXPECT_EQ(std::ranges::count(found, false), 0) << "the wall has holes";
  return seen;
}

// The largest mean difference of colours and normals in a square of a wall with this side. Squares
// are at least as large as a few points.
Seen largest_difference(const Level& level, const Level& finest, double side_m) {
  constexpr int kPoints = 101, kFewest = 4;
  const std::vector<Seen> now = seen_on_wall(level, kPoints), then = seen_on_wall(finest, kPoints);
  const int side = std::clamp(static_cast<int>(side_m / 3 * kPoints) + 1, kFewest, kPoints);
  Seen largest;
  for (int y = 0; y + side <= kPoints; y += side) {
    for (int x = 0; x + side <= kPoints; x += side) {
      Seen sum;
      for (int k = 0; k < side * side; ++k) {
        const auto i = static_cast<std::size_t>((y + k / side) * kPoints + x + k % side);
        sum.colour += now[i].colour - then[i].colour;
        sum.normal += now[i].normal - then[i].normal;
      }
      largest.colour = glm::max(largest.colour, glm::abs(sum.colour) / float(side * side));
      largest.normal = glm::max(largest.normal, glm::abs(sum.normal) / float(side * side));
    }
  }
  return largest;
}

// A level differs only in regions that are smaller than its error.
void expect_honest_errors(const std::vector<Level>& levels) {
  for (const Level& level : levels) {
    const Seen off = largest_difference(level, levels[0], level.error_m);
    EXPECT_LT(std::max({off.colour.x, off.colour.y, off.colour.z}), 0.1F)
        << level.indices.size() << " indices, " << level.error_m << " m";
    EXPECT_LT(std::max({off.normal.x, off.normal.y, off.normal.z}), 0.3F)
        << level.indices.size() << " indices, " << level.error_m << " m";
  }
}

// The number of levels with an error below 1 cm.
std::ptrdiff_t exact_levels(const std::vector<Level>& levels) {
  return std::ranges::count_if(levels, [](const Level& level) { return level.error_m < 0.01; });
}

TEST(Levels, OfACheckeredWallKeepItsColoursWithinTheirErrors) {
  const std::vector<Level> levels = levels_of(wall(64,
                                                   [](Vertex& v) {
                                                     const glm::ivec2 at(1.99F * v.position);
                                                     if ((at.x + at.y) % 2 == 0)
                                                       v.colour = {230, 40, 40};
                                                   }),
                                              8);
  ASSERT_GE(levels.size(), 4U);
  expect_honest_errors(levels);
  EXPECT_GE(exact_levels(levels), 3) << "squares of one colour need few triangles";
  EXPECT_GT(levels.back().error_m, 0.3) << "12 triangles cannot show 36 squares";
}

TEST(Levels, OfAWallOfOneColourNeedFewTriangles) {
  const std::vector<Level> levels = levels_of(wall(64, [](Vertex&) {}), 8);
  EXPECT_LE(levels.back().indices.size(), 3 * 16U);
  EXPECT_LT(levels.back().error_m, 0.001);
  expect_honest_errors(levels);
}

TEST(Levels, OfAWallWithNoiseKeepItsMeanColours) {
  std::uint32_t state = 7;
  const std::vector<Level> levels = levels_of(
      wall(64,
           [&](Vertex& v) {
             for (std::uint8_t& c : v.colour) {
               state = state * 1664525U + 1013904223U;
               c = static_cast<std::uint8_t>((v.position.x < 1.5F ? 60 : 160) + (state >> 24) / 4);
             }
           }),
      8);
  expect_honest_errors(levels);
  ASSERT_GE(levels.size(), 3U);
  EXPECT_LT(levels[2].error_m, 0.5) << "fine noise has no far view of its own";
}

// Two materials meet along a bent line: its vertices are there twice.
TEST(Levels, KeepBordersOfTextures) {
  Triangles t = wall(64, [](Vertex& v) { v.colour = {220, 60, 60}; });
  const auto count = static_cast<std::uint32_t>(t.vertices.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    Vertex other = t.vertices[i];
    other.colour = {40, 60, 200};
    t.vertices.push_back(other);
  }
  for (std::size_t i = 0; i < t.indices.size(); i += 3) {
    const glm::vec3 p = t.vertices[t.indices[i]].position;
    const bool other = glm::length(p - glm::vec3(1.5F, 1.5F, 0)) < 1;
    for (std::size_t k = 0; k < 3 && other; ++k)
      t.indices[i + k] += count;
  }
  const std::vector<Level> levels = levels_of(t, 8);
  ASSERT_GE(levels.size(), 4U);
  expect_honest_errors(levels);
  EXPECT_GE(exact_levels(levels), 2);
  const Level& coarse = levels[1];
  for (std::size_t i = 0; i < coarse.indices.size(); i += 3) {
    const auto colour = [&](std::size_t k) {
      return coarse.vertices[coarse.indices[i + k]].colour;
    };
    EXPECT_TRUE(colour(0) == colour(1) && colour(0) == colour(2)) << "a triangle of two materials";
  }
}

TEST(Levels, KeepVerticesOfDifferentNormalsApartWithinTheirErrors) {
  const std::vector<Level> levels =
      levels_of(wall(64,
                     [](Vertex& v) {
                       if ((v.position.x > 1.5F) != (v.position.y > 1.5F))
                         v.normal = {0.6F, 0, 0.8F};
                     }),
                8);
  ASSERT_GE(levels.size(), 4U);
  expect_honest_errors(levels);
  EXPECT_GE(exact_levels(levels), 3);
  EXPECT_GT(levels.back().error_m, 0.3);
}

TEST(Levels, DropTrianglesThatAreThereTwice) {
  Triangles t;
  t.vertices = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}};
  for (int i = 0; i < 40'000; ++i)
    t.indices.insert(t.indices.end(), {0, 1, 2});
  t.indices.insert(t.indices.end(), {1, 2, 0, 0, 2, 1});
  const std::vector<Level> levels = levels_of(t, 8);
  ASSERT_EQ(levels.size(), 1U);
  EXPECT_EQ(levels[0].indices.size(), 6U) << "both sides";
}

// A vertex of so many triangles must not cost the square of them.
TEST(Levels, OfTrianglesAroundOneVertexCloseUpToADisc) {
  const std::vector<Level> levels = levels_of(fan(60'000), 8);
  ASSERT_GE(levels.size(), 6U);
  EXPECT_EQ(levels[0].indices.size(), 3 * 60'000U);
  EXPECT_LE(levels.back().indices.size(), 3 * 16U);
  EXPECT_LT(levels.back().error_m, 0.1);
}

}  // namespace
}  // namespace psygen::handmade
