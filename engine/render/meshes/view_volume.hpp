// Tests of boxes: which are in view, and which point lights reach. This is the CPU's version of
// shaders/cull.comp, with the same operations in the same order, so both find the same. It tests no
// occlusion. Pure functions, any thread, O(1). Private to engine/render.
#pragma once

#include <array>
#include <glm/mat4x4.hpp>
#include <span>

#include "engine/core/coordinates.hpp"
#include "engine/render/types.hpp"

namespace psygen::render {

// The view volume of a frame.
struct ViewVolume {
  std::array<glm::vec4, 5> planes{};  // inwards: unit normal, offset in metres; no far plane
};
// That of a frame. `clip_from_camera` has infinite reversed depth.
ViewVolume view_volume(const glm::mat4& clip_from_camera);

// False only if the whole box lies outside one plane. Rounding errors favour true.
bool in_view(const ViewVolume& volume, const core::Bounds& box);

// Returns true if the range of one of these lights reaches into the box.
bool any_reaches(std::span<const PointLight> lights, const core::Bounds& box);

}  // namespace psygen::render
