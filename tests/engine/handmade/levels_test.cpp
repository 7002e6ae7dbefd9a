#include "engine/handmade/levels.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

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
    EXPECT_LT(levels[i].error_m, 0.5) << i;
  }
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

}  // namespace
}  // namespace psygen::handmade
