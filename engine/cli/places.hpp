// World positions as users write them: metres from the corner of block (0, 0).
#pragma once

#include <glm/vec2.hpp>

#include "engine/world/world.hpp"

namespace psygen::cli {

// Converts to a world position at height 0. Fails with kInvalidArgument outside the world.
core::Result<core::WorldPosition> position_at(const world::World& world, glm::dvec2 place);

}  // namespace psygen::cli
