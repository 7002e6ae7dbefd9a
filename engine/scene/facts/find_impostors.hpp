// Impostors of a world's trees: finds them and adds the model types that bake and show them. Pure.
#pragma once

#include "engine/core/error.hpp"
#include "engine/scene/facts/world_facts.hpp"

namespace psygen::scene {

// Finds the impostors and adds the types of their meshes to the registry. A world has none without
// levels of detail, and none with data amplification, which makes all levels of all meshes once.
// Reuses the measurements of `before` (may be null). Fails as Registry::add().
core::Result<void> find_pictures(const SceneSettings& settings, WorldFacts& facts,
                                 const world::ImpostorSet* before);

}  // namespace psygen::scene
