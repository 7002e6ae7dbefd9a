// The boxes of draws, and which of them are in view. This is the CPU's version of
// shaders/cull.comp, with the same operations in the same order, so both find the same. It tests no
// occlusion. Pure functions, any thread, O(1). Private to engine/render.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
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

// The box around all vertices as the shaders move them, including skirts and wind. In metres from
// the camera.
core::Bounds bounds_of(const TerrainDraw& draw);
core::Bounds bounds_of(const MeshDraw& draw);
core::Bounds bounds_of(const ObjectDraw& draw);
// Whether the range of one of these lights reaches into the box.
bool any_reaches(std::span<const PointLight> lights, const core::Bounds& box);
// The axes of an object's mesh in the world, each as long as its scale.
glm::mat3 object_axes(const ObjectDraw& draw);

}  // namespace psygen::render
