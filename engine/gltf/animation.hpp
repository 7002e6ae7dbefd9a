// The value of an animation at a time. Pure; any thread.
#pragma once

#include <glm/vec4.hpp>

#include "engine/gltf/model.hpp"

namespace psygen::gltf {

// The value of a channel. Before the first time it has the first value, after the last time the
// last one. Rotations are unit quaternions (x, y, z, w). O(log keys).
glm::vec4 value_at(const Channel& channel, float time_s);

// Writes the value of a channel into the pose of its node; the rest of it stays as it is.
void apply(const Channel& channel, float time_s, Pose& pose);

// The place in an animation after `passed_s` seconds of it (any sign): from its start again, or
// staying at its ends.
float place_in(const Animation& animation, double passed_s, bool loops);

}  // namespace psygen::gltf
