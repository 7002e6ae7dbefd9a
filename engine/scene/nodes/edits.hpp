// Edits of the world on their way into the scene: changed ground and models get new parameters or
// places, and models are created or destroyed. The old meshes are drawn until the new ones are
// ready, as after any other request. Main thread only.
#pragma once

#include <memory>

#include "engine/scene/nodes/entities.hpp"
#include "engine/world/edits/edits.hpp"

namespace psygen::scene {

// The edits that the world gets in the next tick.
struct PendingEdits {
  world::Edits edits;
  bool pending = false;  // WorldFacts does not have them yet
};

// The difference of two edit layers, node by node. `world` outlives it.
class LayerChange {
 public:
  // Null: a layer without edits.
  LayerChange(const world::World& world, std::shared_ptr<const models::EditLayer> before,
              std::shared_ptr<const models::EditLayer> after);

  // The difference of one node.
  NodeChange of(const visibility::NodeCoord& node) const;

 private:
  const world::World& world_;
  std::shared_ptr<const models::EditLayer> before_, after_;  // not null
};

// System: moves pending edits into the world, as far as they hold there (world::fitted()). O(nodes)
// if there are any.
void edits_system(const Daylight& daylight, PendingEdits& pending, WorldFacts& facts,
                  NodeWork work);

}  // namespace psygen::scene
