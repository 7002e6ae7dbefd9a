// The limits of edits: every check of world::Edits and of the decoder of stored edits, with its
// error message. Changes nothing. Pure functions, any thread. Internal to world/edits.
#pragma once

#include <cstdint>
#include <string>

#include "engine/core/error.hpp"
#include "engine/models/edits.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// A block's name in messages.
std::string text_of(core::BlockCoord block);

// Fails for a block outside the world.
core::Result<void> check_block(const World& world, core::BlockCoord block);
// Fails with kOverBudget for more heights in heightmaps than kMaxHeightsPerBlock; and for a block
// that already has the maximum number of edits.
core::Result<void> check_heights(const models::BlockEdits& edits, core::BlockCoord block);
core::Result<void> check_room(const models::BlockEdits& edits, core::BlockCoord block);
// Fails if a block has no model with this index.
core::Result<void> check_removed(const World& world, core::BlockCoord block, std::uint32_t index);

// The normalised position. Fails if it is not finite or outside the world.
core::Result<core::WorldPosition> check_place(const World& world, const core::WorldPosition& at);
// Fails for an edit of the ground that is not legal. O(heights) for a stamp.
core::Result<void> check_ground(const World& world, const models::GroundEdit& edit);
// Fails for a height above the ground that no placed model has.
core::Result<void> check_above(double above_m);
// Fails for a model that cannot be placed at this height above the ground.
core::Result<void> check_model(const models::Registry& registry, models::ModelIndex model,
                               const models::Parameters& parameters, double above_m);

}  // namespace psygen::world
