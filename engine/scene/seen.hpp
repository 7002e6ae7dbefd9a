// The test that decides what is drawn of what could be: whether anything in a box may be seen in
// this tick. Errs on the side of drawing. Pure; main thread, after the visibility system has found
// what the drawn ground hides.
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
