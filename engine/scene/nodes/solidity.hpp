// How much light a node stops, estimated from parameters before anything of it is generated:
// heights of its ground at a few places, and the models that are scattered over it. For PLP's mode
// `solidity` (engine/visibility/plp.hpp), which puts off what lies behind. Pure.
#pragma once

#include <vector>

#include "engine/models/registry.hpp"
#include "engine/visibility/quadtree.hpp"
#include "engine/visibility/solidity.hpp"
#include "engine/world/world.hpp"

namespace psygen::scene {

// What is scattered over a block, each kind by the middle of its parameters' ranges.
std::vector<visibility::Standing> standing_on_block(const world::World& world,
                                                    const models::Registry& registry);

// In [0, 1]. A few microseconds.
float node_solidity(const world::World& world, std::span<const visibility::Standing> on_block,
                    const visibility::NodeCoord& node);

}  // namespace psygen::scene
