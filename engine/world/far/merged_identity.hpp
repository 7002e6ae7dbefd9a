// The identity of the model type "vegetation" of one world: its parameters, and a hash of
// everything in the world that its meshes depend on. Pure functions, any thread. Internal to
// world/far.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "engine/models/registry.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// The parameters, indexed by MergedParameter.
std::span<const models::ParameterSpec> merged_schema();

// ModelType::identity() for a world without edits. `registry` must have every model type of the
// world's scatters.
std::uint64_t merged_identity(const World& world, const models::Registry& registry);

// The world itself if it has no edits, else a copy without them.
std::shared_ptr<const World> without_edits(std::shared_ptr<const World> world);

}  // namespace psygen::world
