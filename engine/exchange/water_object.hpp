// The surface of water over a block or a node, for exports: sea, lakes and rivers. Pure; any
// thread.
#pragma once

#include <optional>

#include "engine/exchange/document.hpp"
#include "engine/world/world.hpp"

namespace psygen::exchange {

// Returns two triangles for each cell of the node's ground that is wet at a corner, in metres from
// the node's corner, upwards, with the colour of the world's water; nothing: no cell is wet. A node
// under nothing but the sea has one large cell. `node` counts nodes of its level; at level 0 it is
// a block. Linear in the cells.
std::optional<Object> water_object(const world::World& world, core::BlockCoord node,
                                   int node_level = 0);

}  // namespace psygen::exchange
