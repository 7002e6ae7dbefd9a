// Finds where roads lead through water: they have no bridges. The same sentences on every machine.
// Pure functions; the world and its layers stay as they are. Internal to world.
#pragma once

#include <string>
#include <vector>

#include "engine/models/edits.hpp"

namespace psygen::world {

struct World;

// A sentence for each stretch of a road's middle that lies in a river, in a lake or below the sea,
// with the place and the length of the stretch; at most kMaxCrossings for a road, then one with the
// number of the others. `layer` has the shapes of the world. Roads are sampled every
// kCrossingStepM: about 1 µs a metre in blocks that may have water or have roads below the sea.
// Ends early when it is cancelled (core/cancellation.hpp).
std::vector<std::string> road_crossings(const World& world, const models::EditLayer& layer);

inline constexpr std::size_t kMaxCrossings = 8;
inline constexpr double kCrossingStepM = 0.5;

}  // namespace psygen::world
