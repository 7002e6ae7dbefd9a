// The value of an animation at a time. Pure; any thread.
#pragma once

#include <glm/vec4.hpp>

#include "engine/gltf/model.hpp"

namespace psygen::gltf {

// The value of a channel. Times outside its range give the first or the last value. Rotations are
// unit quaternions (x, y, z, w). O(log keys).
glm::vec4 value_at(const Channel& channel, float time_s);

// Writes the value of a channel into the pose of its node; the rest of the pose does not change.
void apply(const Channel& channel, float time_s, Pose& pose);

// The time in an animation after `passed_s` seconds (any sign), which wraps around if it `loops`
// and otherwise stops at the ends.
float place_in(const Animation& animation, double passed_s, bool loops);

}  // namespace psygen::gltf
