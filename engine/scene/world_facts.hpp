// What a scene derives from its world once: levels, pictures, light, reach, and the types of meshes
// that stand for more than one model. Touches no renderer, no modelers and no entities. Main
// thread.
#pragma once

#include <vector>

#include "engine/scene/state.hpp"

namespace psygen::scene {

// Fills `facts`, of which world (without edits) and registry are there. May be called again, as
// with `pictures`, whether trees may have pictures. Adds types to the registry. Fails with
// kOverBudget for a view with more than Scene::kMaxEntities nodes and models or Scene::kMaxPlaces
// places for nodes, and as Registry::add(). Some 10 ms; less where `before` (may be null) has parts
// of this world, for the same settings.
core::Result<void> derive(const Settings& settings, bool pictures, WorldFacts& facts,
                          const Derived* before = nullptr);

// The windows in which nodes are kept, one for each level.
std::vector<NodeGrid> node_grids(const Settings& settings, const WorldFacts& facts);

}  // namespace psygen::scene
