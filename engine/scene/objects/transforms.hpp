// Checks of the Transforms that a game writes, and where they are. Pure; any thread.
#pragma once

#include "engine/scene/objects/components.hpp"

namespace psygen::scene {

// Whether a position is within 10⁹ m of its block. NaN is not.
bool is_place(const core::WorldPosition& position);
// The same, with a rotation and a scale of 10⁻⁴ … 10⁴ along each axis.
bool is_valid(const Transform& transform);

// A place relative to the camera, in metres.
inline glm::vec3 offset_of(const core::WorldPosition& position, const core::WorldPosition& camera,
                           double block_size_m) {
  return glm::vec3(core::offset_m(position.block, camera, block_size_m) + position.local);
}

}  // namespace psygen::scene
