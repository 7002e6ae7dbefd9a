#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "engine/core/hash.hpp"
#include "engine/query/solid.hpp"

namespace psygen::query {
namespace {

glm::vec3 random_point(core::RandomStream& random) {
  const auto r = [&] { return static_cast<float>(random.next_real(-1, 1)); };
  const float x = r(), y = r(), z = r();
  return {x, y, z};
}

TEST(Hull, HoldsEveryPointAndEachFaceTouchesPoints) {
  core::RandomStream random(1, 0, 0, 0, core::Purpose::kPosition);
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<glm::vec3> points;
    for (int i = 0; i < 4 + trial; ++i)
      points.push_back(random_point(random) * glm::vec3(3, 1, 0.2F));
    const auto faces = hull_faces(points);
    ASSERT_GE(faces.size(), 4U);
    for (const HalfSpace& face : faces) {
      EXPECT_NEAR(glm::length(face.normal), 1, 1e-5);
      float most = -1e9F;
      for (const glm::vec3& p : points)
        most = std::max(most, glm::dot(face.normal, p) - face.distance);
      EXPECT_NEAR(most, 0, 2e-5);
    }
  }
}

// A point is in the hull exactly if no direction separates it: sampled from inside and outside.
TEST(Hull, IsNotLargerThanThePointsNeed) {
  core::RandomStream random(2, 0, 0, 0, core::Purpose::kPosition);
  std::vector<glm::vec3> sphere;
  for (int i = 0; i < 300; ++i)
    sphere.push_back(glm::normalize(random_point(random)));
  const auto faces = hull_faces(sphere);
  for (int i = 0; i < 500; ++i) {
    const glm::vec3 direction = glm::normalize(random_point(random));
    float leaves = 1e9F;  // parameter at which the ray from the centre leaves the hull
    for (const HalfSpace& face : faces)
      if (const float speed = glm::dot(face.normal, direction); speed > 0)
        leaves = std::min(leaves, face.distance / speed);
    EXPECT_LE(leaves, 1.0001F);
    EXPECT_GE(leaves, 0.8F);
  }
}

TEST(Hull, OfACubeHasSixSidesDespiteEqualAndInnerPoints) {
  std::vector<glm::vec3> points{{0, 0, 0}, {0.3F, 0.1F, -0.2F}};
  for (int i = 0; i < 16; ++i)
    points.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  const auto faces = hull_faces(points);
  EXPECT_EQ(faces.size(), 12U);
  for (const HalfSpace& face : faces) {
    EXPECT_NEAR(face.distance, 1, 1e-6);
    EXPECT_NEAR(std::abs(face.normal.x) + std::abs(face.normal.y) + std::abs(face.normal.z), 1,
                1e-6);
  }
}

TEST(Hull, IsEmptyWithoutVolume) {
  EXPECT_TRUE(hull_faces({}).empty());
  const std::vector<glm::vec3> same(10, {1, 2, 3});
  EXPECT_TRUE(hull_faces(same).empty());
  std::vector<glm::vec3> line, plane;
  for (int i = 0; i < 9; ++i) {
    line.emplace_back(i, 2 * i, 3);
    plane.emplace_back(i % 3, 0, i / 3);
  }
  EXPECT_TRUE(hull_faces(line).empty());
  EXPECT_TRUE(hull_faces(plane).empty());
  std::vector<glm::vec3> broken{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  broken[2].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(hull_faces(broken).empty());
}

}  // namespace
}  // namespace psygen::query
