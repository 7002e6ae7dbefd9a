// Random cameras and grids of blocks for the visibility tests, the same in every run.
#pragma once

#include <vector>

#include "engine/core/camera.hpp"
#include "engine/core/hash.hpp"
#include "engine/visibility/frustum.hpp"

namespace psygen::visibility::testing {

// Side of a block in metres.
inline constexpr double kBlock_m = 64;

// Random numbers of a test. Each file has its own seed.
inline core::RandomStream stream(std::uint64_t seed, std::uint32_t index) {
  return {seed, 0, 0, index, core::Purpose::kPosition};
}

// A camera over a grid whose cell (0, 0) is block (0, 0), and the boxes of its cells.
struct GridScene {
  std::uint32_t width, depth;
  core::CameraPose pose;
  core::Projection projection;
  glm::mat4 view_projection;
  Frustum frustum;
  std::vector<core::Bounds> bounds;

  // w × d cells; each box is 1 to `ground_m` metres high, with its bottom at height 0.
  GridScene(std::uint32_t w, std::uint32_t d, const core::CameraPose& camera, float ground_m = 40)
      : width(w),
        depth(d),
        pose(camera),
        view_projection(core::projection_matrix(projection) * core::view_rotation(camera)),
        frustum(make_frustum(view_projection)) {
    core::RandomStream random(7, static_cast<std::int32_t>(w), static_cast<std::int32_t>(d), 0,
                              core::Purpose::kStructure);
    for (std::int32_t z = 0; z < static_cast<std::int32_t>(d); ++z) {
      for (std::int32_t x = 0; x < static_cast<std::int32_t>(w); ++x) {
        const glm::vec3 corner(core::offset_m({x, z}, pose.position, kBlock_m));
        const auto top = static_cast<float>(random.next_real(1, static_cast<double>(ground_m)));
        const auto side = static_cast<float>(kBlock_m);
        bounds.push_back({corner, corner + glm::vec3(side, top, side)});
      }
    }
  }
};

// A pose over or next to a grid, looking in any direction.
inline core::CameraPose random_pose(core::RandomStream& random, std::uint32_t width,
                                    std::uint32_t depth) {
  core::CameraPose pose;
  pose.position.block = {
      static_cast<std::int32_t>(random.next_integer(-3, static_cast<std::int64_t>(width) + 3)),
      static_cast<std::int32_t>(random.next_integer(-3, static_cast<std::int64_t>(depth) + 3))};
  pose.position.local = {random.next_real(0, kBlock_m), random.next_real(-50, 400),
                         random.next_real(0, kBlock_m)};
  pose.yaw = random.next_real(-4, 4);
  pose.pitch = random.next_real(-1.5, 1.5);
  return pose;
}

}  // namespace psygen::visibility::testing
