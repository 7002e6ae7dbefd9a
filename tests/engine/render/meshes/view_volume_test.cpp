#include "engine/render/meshes/view_volume.hpp"

#include <gtest/gtest.h>

#include <random>

#include "engine/core/camera.hpp"
#include "engine/render/meshes/layouts.hpp"
#include "engine/visibility/frustum.hpp"

namespace psygen::render {
namespace {

struct Random {
  std::mt19937 engine{7};
  float in(float least, float greatest) {
    return std::uniform_real_distribution<float>(least, greatest)(engine);
  }
  core::Bounds box() {
    const glm::vec3 centre(in(-500, 500), in(-60, 60), in(-500, 500));
    const glm::vec3 extent(in(0.1F, 30), in(0.1F, 30), in(0.1F, 30));
    return {centre - extent, centre + extent};
  }
};

FrameInput looking(Random& random) {
  FrameInput input;
  input.pose.yaw = random.in(-3.1F, 3.1F);
  input.pose.pitch = random.in(-1.2F, 1.2F);
  return input;
}

glm::mat4 clip_of(const FrameInput& input) {
  return core::projection_matrix(input.projection) * core::view_rotation(input.pose);
}

TEST(ViewVolume, AgreesWithTheFrustumOfTheVisibilitySystem) {
  Random random;
  int seen = 0;
  for (int camera = 0; camera < 20; ++camera) {
    const FrameInput input = looking(random);
    const ViewVolume test = view_volume(clip_of(input));
    const visibility::Frustum frustum = visibility::make_frustum(clip_of(input));
    for (int i = 0; i < 500; ++i) {
      const core::Bounds box = random.box();
      EXPECT_EQ(in_view(test, box), visibility::intersects(frustum, box));
      seen += in_view(test, box) ? 1 : 0;
    }
  }
  EXPECT_GT(seen, 500);
  EXPECT_LT(seen, 9500);
}

TEST(ViewVolume, PutsSkirtsAndWindIntoTheBoxes) {
  TerrainDraw terrain;
  terrain.origin = {10, -5, 20};
  terrain.cell_m = 2;
  terrain.height_min_m = 3;
  terrain.height_range_m = 7;
  terrain.skirt_m = 4;
  EXPECT_EQ(bounds_of(terrain), (core::Bounds{{10, -6, 20}, {264, 5, 274}}));
  terrain.side_m = 64;
  EXPECT_EQ(bounds_of(terrain), (core::Bounds{{10, -6, 20}, {74, 5, 84}}));
  MeshDraw mesh;
  mesh.origin = {1, 2, 3};
  mesh.box_centre = {0, 4, 0};
  mesh.box_half_extent = {1, 4, 1};
  const core::Bounds box = bounds_of(mesh);
  EXPECT_FLOAT_EQ(box.min.y, 2.0F);
  EXPECT_FLOAT_EQ(box.max.y, 10.0F);
  EXPECT_FLOAT_EQ(box.max.x, 1.0F + 1.12F);
  EXPECT_FLOAT_EQ(box.min.z, 3.0F - 1.09F);
}

}  // namespace
}  // namespace psygen::render
