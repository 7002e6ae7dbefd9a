// The shape of a handmade model, measured once when its file is read: levels of detail, collider
// and identity. Immutable; shared by all model types of the file. Any thread.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/handmade/levels.hpp"

namespace psygen::handmade {

struct Shape {
  std::vector<Level> levels;     // at least one
  std::vector<glm::vec3> solid;  // corners of the convex collider; empty: no collider
  core::Bounds box;              // bounds of all vertices of all levels
  float radius_m = 0;            // maximum distance of vertices and collider from the vertical axis
  std::uint64_t identity = 0;    // hash of the file's triangles and the settings; not 0
};

// Fails like triangles_of(). `how` has passed the checks of world files.
core::Result<std::shared_ptr<const Shape>> shape_of(const gltf::Model& model,
                                                    const world::HandmadeModel& how);

}  // namespace psygen::handmade
