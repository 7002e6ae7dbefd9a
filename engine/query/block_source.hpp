// What queries know of a block: its ground and its models. These two functions are the only places
// where queries and physics get them. Pure, any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/models/registry.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/world.hpp"

namespace psygen::query {

// The quantised heights of the vertices of a block's finest mesh, row by row. About 15 µs for 64 x
// 64 vertices. Needs 350 KiB of stack.
std::vector<std::uint16_t> ground_of_block(const world::World& world, core::BlockCoord block);

// The models of a block by growing index. As long, and 0.1 µs for each model. Needs 350 KiB of
// stack.
std::vector<world::Placement> models_of_block(const world::World& world,
                                              const models::Registry& registry,
                                              core::BlockCoord block);

// Tells whether the edits of a world changed a block: equal hashes, equal ground and models;
// 0: no edits. Logarithmic in the edits.
std::uint64_t edits_of_block(const world::World& world, core::BlockCoord block);

}  // namespace psygen::query
