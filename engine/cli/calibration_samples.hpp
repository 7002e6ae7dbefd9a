// The models of a world that `psygen calibrate` measures: one half for fitting, the other for
// prediction. Pure.
#pragma once

#include <vector>

#include "engine/synthesis/cost_model.hpp"
#include "engine/world/world.hpp"

namespace psygen::cli {

// Returns at most `most` existing blocks of `world`, from its first half (0) or its second (1). The
// only block of a world is in both.
std::vector<core::BlockCoord> sample_blocks(const world::World& world, int half, std::size_t most);

// Returns up to `count` parameter sets of each type that occurs in that half, from `count` blocks.
// Rare types are searched in eight times as many; terrain nodes cycle through all levels.
std::vector<synthesis::CostSample> world_samples(const world::World& world,
                                                 const models::Registry& registry, int half,
                                                 std::size_t count);

}  // namespace psygen::cli
