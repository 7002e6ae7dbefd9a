// Derives the values of WorldFacts from a world, once: levels, impostors, light, reach, and the
// types of meshes that stand for more than one model. Touches no renderer, no modelers and no
// entities. Main thread.
#pragma once

#include <span>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/core/error.hpp"
#include "engine/models/registry.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/synthesis/cost_model.hpp"

namespace psygen::scene {

inline constexpr double kMaxEntities = 2e6;
inline constexpr double kMaxPlaces = 4e6;  // for nodes around the camera

// Derives `facts` from their world (without edits) and registry, and adds types to the registry.
// May be called again, for example with another value of `pictures` (true: trees may have
// impostors). Fails with kOverBudget for a view with more than kMaxEntities nodes and models or
// kMaxPlaces places for nodes, and as Registry::add(). Takes about 10 ms; less if `before` (may be
// null) has parts of this world, for the same settings.
core::Result<void> derive(const SceneSettings& settings, bool pictures, WorldFacts& facts,
                          const DerivedWorldData* before = nullptr);

// Returns for each type the bounds around the coarsest meshes of its first samples, in −1 … 1 along
// each axis of ModelType::bounds(). Types without samples, and types that fail, get the whole
// bounds. Conservative bounds cover all parameters, for a tree several times its size: good for
// tests that must never miss, but not for distance or size. Runs models; at start only.
std::vector<core::Bounds> typical_bounds(const models::Registry& registry,
                                         std::span<const synthesis::CostSample> samples);

// Samples that calibrate the cost model before the first frame. Runs no model; at start only.
// Ground meshes of nodes of every level, and some models of every type, from all over the world:
// places differ in what grows there. Takes some milliseconds for a world of many species.
std::vector<synthesis::CostSample> cost_samples(const WorldFacts& facts);

// Some models of every type on one block.
std::vector<synthesis::CostSample> models_on(const WorldFacts& facts, core::BlockCoord block);

}  // namespace psygen::scene
