// Estimates the solidity of a node from parameters, before any mesh exists: heights of its ground
// at some points, and its scattered models. For PLP's mode `solidity` (engine/visibility/plp.hpp),
// which defers nodes behind solid ones. Pure.
#pragma once

#include <vector>

#include "engine/models/registry.hpp"
#include "engine/visibility/quadtree.hpp"
#include "engine/visibility/solidity.hpp"
#include "engine/world/world.hpp"

namespace psygen::scene {

// The scattered obstacles on a block, each with the middle of its parameter ranges.
std::vector<visibility::Standing> obstacles_on_block(const world::World& world,
                                                     const models::Registry& registry);

// Returns the solidity in [0, 1]. Takes some microseconds.
float node_solidity(const world::World& world, std::span<const visibility::Standing> on_block,
                    const visibility::NodeCoord& node);

}  // namespace psygen::scene
