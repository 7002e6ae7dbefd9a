// Sample models of a world that calibrate the cost model before the first frame. Runs no model; at
// start only.
#pragma once

#include <vector>

#include "engine/scene/facts/world_facts.hpp"
#include "engine/synthesis/cost_model.hpp"

namespace psygen::scene {

// Ground meshes of nodes of every level, and some models of every type, from all over the world:
// places differ in what grows there. Takes some milliseconds for a world of many species.
std::vector<synthesis::CostSample> cost_samples(const WorldFacts& facts);

// Some models of every type on one block.
std::vector<synthesis::CostSample> models_on(const WorldFacts& facts, core::BlockCoord block);

}  // namespace psygen::scene
