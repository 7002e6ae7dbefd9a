// Decides which draws of a frame are in view, and their level of detail. This is the CPU's version
// of shaders/cull.comp, with the same operations in the same order, so both choose the same. It
// tests no occlusion. Pure functions, any thread, linear in the draws. Private to engine/render.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

// The view volume and the allowed error of a frame.
struct ViewTest {
  std::array<glm::vec4, 5> planes{};  // inwards: unit normal, offset in metres; no far plane
  float pixels_per_radian = 1.0F;
  float max_error_pixels = 0.0F;
};
// The test of a frame. `clip_from_camera` has infinite reversed depth. `height` is that of the
// picture in pixels.
ViewTest view_test(const glm::mat4& clip_from_camera, const FrameInput& input, float height);

// False only if the whole box lies outside one plane. Rounding errors favour true.
bool in_view(const ViewTest& test, const core::Bounds& box);

// The level to draw: 0 for the draw's own mesh, else 1 + the position in `coarser`. Goes through
// the levels in order as long as their error is small enough at the nearest point of the box.
std::size_t level_of(const ViewTest& test, const core::Bounds& box,
                     std::span<const DrawLevel> coarser);

// The box around all vertices as the shaders move them, including skirts and wind. In metres from
// the camera.
core::Bounds bounds_of(const TerrainDraw& draw);
core::Bounds bounds_of(const MeshDraw& draw);
core::Bounds bounds_of(const ObjectDraw& draw);
// The axes of an object's mesh in the world, each as long as its scale.
glm::mat3 object_axes(const ObjectDraw& draw);

// Replaces `chosen` by the draws in view, in the same order, with the range and the index list of
// the chosen level.
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
