// The test that decides what is drawn of what could be: whether anything in a box may be seen in
// this tick, or soon. Errs on the side of drawing. Pure; main thread, after the visibility system
// has found what the drawn ground hides.
#pragma once

#include "engine/scene/state.hpp"

namespace psygen::scene {

// `box` is relative to the camera. False only if it lies beside the picture or behind the ground.
inline bool can_be_seen(const core::Bounds& box, const View& view) {
  return visibility::intersects(view.frustum, box) && !view.horizon.hides(box);
}

// The same for a mesh that stands at `foot` and may sway in the wind; `box` is relative to it.
inline bool mesh_can_be_seen(const core::Bounds& box, glm::vec3 foot, const View& view) {
  return can_be_seen({foot + box.min - render::kSwayM, foot + box.max + render::kSwayM}, view);
}

// The first predicted camera that would see it, if no ground hides it; null: none.
inline const Outlook* first_to_see(const core::Bounds& box, glm::vec3 foot, const View& view) {
  for (const Outlook& outlook : view.outlooks) {
    const glm::vec3 there = foot - outlook.moved;
    if (visibility::intersects(outlook.frustum, {there + box.min, there + box.max}))
      return &outlook;
  }
  return nullptr;
}

}  // namespace psygen::scene
