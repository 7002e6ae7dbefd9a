// The visibility of a tick. Values; main thread only.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "ecs/entity.hpp"
#include "engine/core/coordinates.hpp"
#include "engine/visibility/frustum.hpp"
#include "engine/visibility/horizon.hpp"
#include "engine/visibility/plp.hpp"
#include "engine/visibility/quadtree.hpp"

namespace psygen::scene {

// The nodes of one level. Cells are those of its window, row by row.
struct LevelView {
  visibility::PlpResult plp;
  std::vector<core::Bounds> bounds;  // relative to the camera
  std::vector<float> solidity;       // used by PLP's solidity mode only
  std::vector<float> deadlines;      // seconds until the node is expected in view; +inf: it is not
  std::vector<std::uint8_t> part;    // its part in the cut (visibility system); 0: none
};

// A node that this frame depends on.
struct ChosenNode {
  ecs::Entity entity;
  std::uint8_t level = 0;
  bool leaf = true;      // this level is wanted here; false: an ancestor of wanted nodes
  bool fine = false;     // wanted with the finest mesh
  bool in_view = false;  // false: a sibling of a node in view; without it the parent stays
  bool covered = false;  // an ancestor is drawn instead, or could be
};

// The view of a predicted camera.
struct PredictedView {
  float tau_s = 0;        // seconds from now
  glm::vec3 moved{0.0F};  // from the camera's present position
  visibility::Frustum frustum;
};

struct View {
  visibility::Frustum frustum;
  std::vector<PredictedView> outlooks;  // soonest first
  visibility::Cut cut;                  // nodes that should be drawn
  std::vector<visibility::NodeCoord> roots;
  visibility::Horizon horizon;        // of the drawn ground
  std::vector<std::uint8_t> in_view;  // per node of the cut: in the frustum, not behind the horizon
  std::vector<std::uint8_t> ready;    // per node of the cut: drawable before this tick
  std::vector<std::uint32_t> drawn;   // indices into the cut: the ready nodes that are drawn
  std::vector<std::uint8_t> scratch;
  std::vector<LevelView> levels;
  std::vector<ChosenNode> chosen;     // from the cut, ancestors first, front to back
  std::vector<ecs::Entity> expected;  // nodes expected in view, soonest first
  // Siblings of expected nodes, and ancestors of all others, which are drawn instead of these if
  // the camera turns unexpectedly. Coarsest level first.
  std::vector<ecs::Entity> around;
  std::vector<ecs::Entity> kept;  // all other nodes: they request no missing meshes
  std::uint32_t hidden = 0;       // nodes of the cut behind ridges
};

}  // namespace psygen::scene
