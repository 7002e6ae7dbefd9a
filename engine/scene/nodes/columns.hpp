// What a model, or the ground of a node, is as a mesh entity: the values of the columns that both
// have. For entities, and for places that have none yet (readiness.hpp). Pure functions.
#pragma once

#include <climits>

#include "engine/scene/components.hpp"
#include "engine/scene/state.hpp"
#include "engine/world/placement.hpp"

namespace psygen::scene {

struct MeshColumns {
  Placed placed;
  Detail detail;
  Source source;
};
// Of the levels of the type only these are used; where there are pictures, none beyond the picture.
MeshColumns columns_of(const WorldFacts& facts, core::BlockCoord block,
                       const world::Placement& placement, int first_level = 0,
                       int last_level = INT_MAX);

// The one mesh of all models on a node of level 1 or above.
world::Placement merged_placement(const WorldFacts& facts, const visibility::NodeCoord& at);

}  // namespace psygen::scene
