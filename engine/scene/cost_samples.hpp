// Models of a world by which the cost model is calibrated before the first frame. Runs no model; at
// start only.
#pragma once

#include <vector>

#include "engine/scene/state.hpp"
#include "engine/synthesis/cost_model.hpp"

namespace psygen::scene {

// What nodes of every level draw, and some models of every type, from all over the world: what
// grows in one place is not what grows in another. Some milliseconds for a world of many species.
std::vector<synthesis::CostSample> cost_samples(const WorldFacts& facts);

// Some models of every type that stands on a block.
std::vector<synthesis::CostSample> models_on(const WorldFacts& facts, core::BlockCoord block);

}  // namespace psygen::scene
