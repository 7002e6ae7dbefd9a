#include "engine/visibility/frustum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "tests/engine/visibility/scenes.hpp"

namespace psygen::visibility {
namespace {

using testing::GridScene;
using testing::random_pose;
using testing::stream;

Frustum frustum_of(const core::CameraPose& pose) {
  return make_frustum(core::projection_matrix({}) * core::view_rotation(pose));
}

core::Bounds cube(glm::vec3 centre, float half) {
  return {centre - glm::vec3(half), centre + glm::vec3(half)};
}

TEST(Frustum, PlanesHaveUnitNormals) {
  core::RandomStream random = stream(11, 0);
  for (int i = 0; i < 50; ++i) {
    for (const glm::vec4& plane : frustum_of(random_pose(random, 9, 9)).planes)
      EXPECT_NEAR(glm::length(glm::vec3(plane.x, plane.y, plane.z)), 1, 1e-5);
  }
}

TEST(Frustum, BoxesAheadAreInAndBoxesBehindOrBesideAreOut) {
  const Frustum frustum = frustum_of({});
  EXPECT_TRUE(intersects(frustum, cube({0, 0, -10}, 1)));
  EXPECT_FALSE(intersects(frustum, cube({0, 0, 10}, 1)));
  EXPECT_FALSE(intersects(frustum, cube({-30, 0, -10}, 1)));
  EXPECT_FALSE(intersects(frustum, cube({30, 0, -10}, 1)));
  EXPECT_FALSE(intersects(frustum, cube({0, 30, -10}, 1)));
  EXPECT_FALSE(intersects(frustum, cube({0, -30, -10}, 1)));
}

TEST(Frustum, HasNoFarPlane) {
  EXPECT_TRUE(intersects(frustum_of({}), cube({0, 0, -1e7F}, 1)));
}

TEST(Frustum, ABoxBetweenTheCameraAndTheNearPlaneIsOut) {
  EXPECT_FALSE(intersects(frustum_of({}), cube({0, 0, -0.05F}, 0.05F)));
}

TEST(Frustum, TheBoxAroundTheCameraIsAlwaysIn) {
  core::RandomStream random = stream(11, 1);
  for (int i = 0; i < 200; ++i)
    EXPECT_TRUE(intersects(frustum_of(random_pose(random, 9, 9)), cube({0, 0, 0}, 1)));
}

TEST(Frustum, NeverRejectsABoxWithAPointInsideTheImage) {
  core::RandomStream random = stream(11, 2);
  int in_picture = 0;
  for (int i = 0; i < 300; ++i) {
    const GridScene scene(6, 6, random_pose(random, 6, 6));
    for (const core::Bounds& box : scene.bounds) {
      const glm::vec3 t{random.next_unit(), random.next_unit(), random.next_unit()};
      const glm::vec3 point = box.min + t * (box.max - box.min);
      const glm::vec4 clip = scene.view_projection * glm::vec4(point, 1);
      if (std::abs(clip.x) > clip.w || std::abs(clip.y) > clip.w || clip.z > clip.w) continue;
      ++in_picture;
      EXPECT_TRUE(intersects(scene.frustum, box));
    }
  }
  EXPECT_GT(in_picture, 300);
}

TEST(Frustum, RejectsMostBoxesOutOfView) {
  // A quarter of the circle at most lies between the planes; corners may add a little.
  const GridScene scene(41, 41, {{{20, 20}, {32, 50, 32}}, 0.3, -0.2});
  std::vector<std::uint8_t> in_view(scene.bounds.size());
  intersects(scene.frustum, scene.bounds, in_view);
  const auto count = std::count(in_view.begin(), in_view.end(), 1);
  EXPECT_GT(count, 100);
  EXPECT_LT(count, 41 * 41 * 2 / 5);
}

TEST(Frustum, TheBatchAgreesWithTheSingleTest) {
  core::RandomStream random = stream(11, 3);
  for (int i = 0; i < 20; ++i) {
    const GridScene scene(13, 7, random_pose(random, 13, 7));
    std::vector<std::uint8_t> in_view(scene.bounds.size());
    intersects(scene.frustum, scene.bounds, in_view);
    for (std::size_t k = 0; k < in_view.size(); ++k)
      EXPECT_EQ(in_view[k] == 1, intersects(scene.frustum, scene.bounds[k]));
  }
}

}  // namespace
}  // namespace psygen::visibility
