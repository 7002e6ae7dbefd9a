// Checks of a game's Transforms, and their positions relative to the camera. Pure; any thread.
#pragma once

#include "engine/scene/objects/components.hpp"

namespace psygen::scene {

// True for a position within 10⁹ m of its block. NaN is not.
bool is_place(const core::WorldPosition& position);
// True if the position is valid, the rotation is not zero, and the scale is 10⁻⁴ … 10⁴ along each
// axis.
bool is_valid(const Transform& transform);

// A position relative to the camera, in metres.
inline glm::vec3 offset_of(const core::WorldPosition& position, const core::WorldPosition& camera,
                           double block_size_m) {
  return glm::vec3(core::offset_m(position.block, camera, block_size_m) + position.local);
}

}  // namespace psygen::scene
