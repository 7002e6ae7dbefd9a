// The extent of a world's models from their base points. Pure, any thread.
#pragma once

#include <glm/vec2.hpp>

#include "engine/models/registry.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// The largest extent of any scattered model from its base point in metres: sideways along x or z,
// and up. Takes the largest bounds (ModelType::bounds) over the corners of every scatter's
// parameter ranges; up to 4096 bounds a scatter.
glm::vec2 models_reach_m(const World& world, const models::Registry& registry);

// The maximum of `scattered`, a result of models_reach_m(), and the extents of the models that
// edits have placed. O(1).
glm::vec2 with_placed_models(glm::vec2 scattered, const World& world);

}  // namespace psygen::world
