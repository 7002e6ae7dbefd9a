// Sample models of a world, and the typical bounds of model types. The conservative bounds of a
// type cover all parameters, for a tree several times its size: good for tests that must never
// miss, but not for distance or size. Runs models; at start only.
#pragma once

#include <span>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/models/registry.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/synthesis/cost_model.hpp"

namespace psygen::scene {

// Returns for each type the bounds around the coarsest meshes of its first samples, in −1 … 1 along
// each axis of ModelType::bounds(). Types without samples, and types that fail, get the whole
// bounds.
std::vector<core::Bounds> typical_bounds(const models::Registry& registry,
                                         std::span<const synthesis::CostSample> samples);

// Samples that calibrate the cost model before the first frame. Runs no model; at start only.
// Ground meshes of nodes of every level, and some models of every type, from all over the world:
// places differ in what grows there. Takes some milliseconds for a world of many species.
std::vector<synthesis::CostSample> cost_samples(const WorldFacts& facts);

// Some models of every type on one block.
std::vector<synthesis::CostSample> models_on(const WorldFacts& facts, core::BlockCoord block);

}  // namespace psygen::scene
