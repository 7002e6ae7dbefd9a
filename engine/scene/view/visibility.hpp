// The nodes that should be drawn: the cut through the quadtree, and Prioritized-Layered Projection
// over the nodes of each level (paper, section 4) from the camera's position. Nodes that a
// predicted camera would see get a deadline. Models inherit their node's key. Main thread only.
#pragma once

#include "engine/render/types.hpp"
#include "engine/scene/components.hpp"
#include "engine/scene/nodes/ground_occluder.hpp"
#include "engine/scene/nodes/streaming.hpp"
#include "engine/scene/view/view.hpp"

namespace psygen::scene {

struct Input;

// Bundle: nodes, and their visibility.
struct VisibleNodes {
  const Streaming& streaming;
  const View& view;
};

// Bundle: everything that decides how a frame looks, except meshes.
struct RenderContext {
  FrameContext frame;
  const Input& input;
  const Camera& camera;
  const Quality& quality;
  const WorldFacts& facts;
  const Streaming& streaming;
  const View& view;
};

// The corner of a node at height 0, relative to the camera.
glm::vec3 corner_of(const visibility::NodeCoord& node, const Camera& camera,
                    const WorldFacts& facts);

// Potential visibility: the tests behind every draw list. They err on the side of drawing. Call
// them after the visibility system has found the horizon.

// `box` is relative to the camera. False only if it lies outside the frustum or behind the ground.
inline bool may_be_visible(const core::Bounds& box, const View& view) {
  return visibility::intersects(view.frustum, box) && !view.horizon.hides(box);
}

// As may_be_visible(), for a mesh with its base point at `foot` that may sway in the wind. `box` is
// relative to `foot`.
inline bool mesh_may_be_visible(const core::Bounds& box, glm::vec3 foot, const View& view) {
  return may_be_visible({foot + box.min - render::kSwayM, foot + box.max + render::kSwayM}, view);
}

// The soonest predicted view that would show a box if no ground hid it; null: none.
inline const PredictedView* first_to_see(const core::Bounds& box, glm::vec3 foot,
                                         const View& view) {
  for (const PredictedView& outlook : view.outlooks) {
    const glm::vec3 there = foot - outlook.moved;
    if (visibility::intersects(outlook.frustum, {there + box.min, there + box.max}))
      return &outlook;
  }
  return nullptr;
}

// System: chooses the cut and finds the visibility of all nodes.
using VisibilityQuery = ecs::Query<const QuadtreeNode, const MissingMeshes, const MeshDemand,
                                   const GroundOccluder, Visibility>;
void visibility_system(FrameContext frame, const Camera& camera, const WorldFacts& facts,
                       const Streaming& streaming, VisibilityQuery nodes, View& view);

}  // namespace psygen::scene
