// How far the models of a world reach from their feet. Pure, any thread.
#pragma once

#include <glm/vec2.hpp>

#include "engine/models/registry.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// How far models may reach from their foot in metres: sideways along x or z, and up. The largest
// boxes (ModelType::bounds) over the corners of the ranges of every scatter. Takes up to 4096 boxes
// a scatter.
glm::vec2 models_reach_m(const World& world, const models::Registry& registry);

}  // namespace psygen::world
