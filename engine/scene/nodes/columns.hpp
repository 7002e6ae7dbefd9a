// The column values of a mesh entity: a model, or the ground of a node. For entities, and for
// requested places without entities (meshes/requested_places.hpp). Pure functions.
#pragma once

#include <climits>

#include "engine/scene/components.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/world/placement.hpp"

namespace psygen::scene {

struct MeshColumns {
  MeshPlacement placed;
  LodErrors detail;
  MeshSource source;
};
// Uses only these levels of the type, and none beyond an impostor.
MeshColumns columns_of(const WorldFacts& facts, core::BlockCoord block,
                       const world::Placement& placement, int first_level = 0,
                       int last_level = INT_MAX);

// The merged mesh of a node of level 1 or above.
world::Placement merged_placement(const WorldFacts& facts, const visibility::NodeCoord& at);

}  // namespace psygen::scene
