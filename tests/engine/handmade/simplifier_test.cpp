#include "engine/handmade/simplifier.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "engine/handmade/appearance.hpp"
#include "tests/engine/handmade/shapes.hpp"

namespace psygen::handmade {
namespace {

TEST(Simplifier, ReachesTheNumberOfTrianglesOnAClosedSurface) {
  const Triangles t = sphere(32, 64);
  Simplifier simplifier(t.vertices, t.indices);
  for (const std::size_t wanted : {2000U, 500U, 100U, 20U}) {
    simplifier.reduce_to(wanted);
    EXPECT_LE(simplifier.triangle_count(), wanted);
    EXPECT_GT(simplifier.triangle_count(), wanted - 10);
    EXPECT_EQ(simplifier.indices().size(), 3 * simplifier.triangle_count());
  }
}

TEST(Simplifier, FindsTheNearestPointOfWhatIsLeft) {
  const Triangles t = wall(32, [](Vertex&) {});
  Simplifier simplifier(t.vertices, t.indices);
  simplifier.reduce_to(20);
  for (std::uint32_t i = 0; 3 * i < t.indices.size(); ++i) {
    glm::vec3 middle(0.0F);
    for (std::size_t k = 0; k < 3; ++k)
      middle += t.vertices[t.indices[3 * i + k]].position / 3.0F;
    const Simplifier::Match match =
        simplifier.nearest(i, {middle + glm::vec3(0, 0, 0.1), {0, 0, 1}});
    ASSERT_TRUE(match.is_found);
    EXPECT_NEAR(match.distance_m, 0.1, 1e-4);
    glm::vec3 point(0.0F);
    for (int k = 0; k < 3; ++k)
      point += match.weights[k] * t.vertices[simplifier.corners(match.triangle)[k]].position;
    EXPECT_LT(glm::length(point - middle), 1e-3F);
    EXPECT_FALSE(simplifier.nearest(i, {middle, {0, 0, -1}}).is_found) << "this is the back";
  }
}

// Work in proportion to the triangles, however they hang together.
TEST(Simplifier, BoundsItsWork) {
  for (const std::uint32_t size : {2'000U, 8'000U}) {
    for (Triangles t : {fan(size), tangle(size, 40), tangle(size, size / 2)}) {
      for (std::size_t i = t.indices.size(); i > 0; i -= 3) {
        const std::uint32_t* c = &t.indices[i - 3];
        const auto at = [&](int k) { return t.vertices[c[k]].position; };
        if (!(glm::length(glm::cross(at(1) - at(0), at(2) - at(0))) > 0))
          t.indices.erase(t.indices.begin() + static_cast<std::ptrdiff_t>(i - 3),
                          t.indices.begin() + static_cast<std::ptrdiff_t>(i));
      }
      Simplifier simplifier(t.vertices, t.indices);
      simplifier.reduce_to(1);
      EXPECT_LT(simplifier.work(), 100 * std::size_t{size});
    }
  }
}

TEST(Appearance, IsRightIfNothingIsMissing) {
  const Triangles t =
      wall(32, [](Vertex& v) { v.colour[1] = v.position.x < v.position.y ? 9 : 99; });
  Simplifier simplifier(t.vertices, t.indices);
  std::vector<Vertex> vertices = t.vertices;
  EXPECT_LT(Appearance(t.vertices, t.indices).fit(vertices, simplifier), 1e-6);
}

TEST(Appearance, GivesVerticesTheColoursOfTheSurface) {
  const Triangles t = wall(16, [](Vertex& v) { v.colour[0] = v.position.x < 1 ? 50 : 200; });
  Simplifier simplifier(t.vertices, t.indices);
  std::vector<Vertex> vertices = t.vertices;
  for (Vertex& v : vertices)
    v.colour[0] = 120;
  EXPECT_LT(Appearance(t.vertices, t.indices).fit(vertices, simplifier), 0.5);
  for (const Vertex& v : vertices) {
    if (std::abs(v.position.x - 1) < 0.4F) continue;
    EXPECT_NEAR(v.colour[0], v.position.x < 1 ? 50 : 200, 8);
  }
}

// Normals cannot be fitted, so the size of the region is the error.
TEST(Appearance, MeasuresTheSizeOfAWrongRegion) {
  const Triangles t = wall(64, [](Vertex&) {});
  Simplifier simplifier(t.vertices, t.indices);
  const Appearance appearance(t.vertices, t.indices);
  for (const float side_m : {0.4F, 1.2F}) {
    std::vector<Vertex> vertices = t.vertices;
    for (Vertex& v : vertices)
      if (std::max(v.position.x, v.position.y) < side_m) v.normal = {0.6F, 0, 0.8F};
    const double error_m = appearance.fit(vertices, simplifier);
    EXPECT_GT(error_m, 0.8 * side_m);
    EXPECT_LT(error_m, 3 * side_m);
  }
}

}  // namespace
}  // namespace psygen::handmade
