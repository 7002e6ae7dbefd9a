// The ground and the models of a block, for queries and physics, which use no other source. Pure,
// any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/models/registry.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/world.hpp"

namespace psygen::query {

// Returns the quantised heights of the vertices of a block's finest mesh, row by row. About 15 µs
// for 64 x 64 vertices. Needs 350 KiB of stack.
std::vector<std::uint16_t> ground_of_block(const world::World& world, core::BlockCoord block);

// Returns the models of a block by growing index. Takes as long, plus 0.1 µs for each model. Needs
// 350 KiB of stack.
std::vector<world::Placement> models_of_block(const world::World& world,
                                              const models::Registry& registry,
                                              core::BlockCoord block);

// Returns a hash of the edits that change a block; 0 if none do. Equal hashes: equal ground and
// models. Logarithmic in the edits.
std::uint64_t edits_of_block(const world::World& world, core::BlockCoord block);

}  // namespace psygen::query
