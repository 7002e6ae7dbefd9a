// Derives the values of WorldFacts from a world, once: levels, impostors, light, reach, and the
// types of meshes that stand for more than one model. Touches no renderer, no modelers and no
// entities. Main thread.
#pragma once

#include "engine/core/error.hpp"
#include "engine/scene/facts/world_facts.hpp"

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

}  // namespace psygen::scene
