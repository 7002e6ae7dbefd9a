// Whether anything in a box may be seen in this tick. Pure.
#pragma once

#include "engine/scene/state.hpp"

namespace psygen::scene {

// How far the wind moves a vertex at most (shaders/model.vert).
inline constexpr float kSwayM = 0.15F;

// `box` is relative to the camera. False only if it lies beside the picture or behind the ground.
inline bool can_be_seen(const core::Bounds& box, const View& view) {
  return visibility::intersects(view.frustum, box) && !view.horizon.hides(box);
}

}  // namespace psygen::scene
