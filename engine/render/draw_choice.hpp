// What of a frame's draws is in view and at which level of detail: the CPU's side of what
// shaders/cull.comp decides on the device, with the same operations in the same order, so that both
// choose the same. Pure functions. Private to engine/render.
#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

struct ViewTest {
  std::array<glm::vec4, 5> planes{};  // inwards: unit normal, offset in metres; no far plane
  float pixels_per_radian = 1.0F;
  float max_error_pixels = 0.0F;
};
// `clip_from_camera` with infinite reversed depth. `height` of the picture in pixels.
ViewTest view_test(const glm::mat4& clip_from_camera, const FrameInput& input, float height);

// False only if all of the box lies outside one plane. Rounding is on the side of true.
bool in_view(const ViewTest& test, const core::Bounds& box);

// 0 for the draw's own mesh, else 1 + the place in `coarser`: the last level of those in order
// whose error is small enough at the nearest point of the box.
std::size_t level_of(const ViewTest& test, const core::Bounds& box,
                     std::span<const DrawLevel> coarser);

// Around all that the shaders make of a draw: skirts, fading and wind included.
core::Bounds bounds_of(const TerrainDraw& draw);
core::Bounds bounds_of(const MeshDraw& draw);

// The draws in view, with range and index list of the level that was chosen, in the same order.
template <class Draw>
void choose_draws(const ViewTest& test, std::span<const Draw> draws, std::vector<Draw>& chosen) {
  chosen.clear();
  for (const Draw& draw : draws) {
    const core::Bounds box = bounds_of(draw);
    if (!in_view(test, box)) continue;
    chosen.push_back(draw);
    const std::size_t level = level_of(test, box, draw.coarser);
    if (level == 0) continue;
    chosen.back().range = draw.coarser[level - 1].range;
    chosen.back().shared_indices = draw.coarser[level - 1].shared_indices;
    if constexpr (requires { draw.part; }) chosen.back().part = {};
  }
}

}  // namespace psygen::render
