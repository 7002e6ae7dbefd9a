// The models of a world that `psygen calibrate` measures: one half to fit, the other to predict.
// Pure.
#pragma once

#include <vector>

#include "engine/synthesis/cost_model.hpp"
#include "engine/world/world.hpp"

namespace psygen::cli {

// Blocks that exist in `world`, at most `most`, from its first half (0) or its second (1); the only
// block of a world is in both.
std::vector<core::BlockCoord> sample_blocks(const world::World& world, int half, std::size_t most);

// Up to `count` parameter sets of each type that stands in that half, from `count` blocks, and from
// eight times as many for types that are rare; of the terrain nodes of all levels in turn.
std::vector<synthesis::CostSample> world_samples(const world::World& world,
                                                 const models::Registry& registry, int half,
                                                 std::size_t count);

}  // namespace psygen::cli
