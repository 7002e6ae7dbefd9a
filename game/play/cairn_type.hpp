// Model type of a cairn: a stack of flat stones, each smaller than the one below. Hidden cairns and
// the player's cairns are both edits of the world, so they are drawn, solid and saved like all
// models. A pure function of its parameters.
#pragma once

#include <memory>

#include "engine/models/model_type.hpp"

namespace cairns {

using namespace psygen;

// Parameter indices, in the order of the schema.
enum CairnParameter : std::size_t { kCairnSeed, kCairnStones, kCairnWidthM };

inline constexpr const char* kCairnType = "cairn";
// Returns the type of this name.
std::unique_ptr<models::ModelType> make_cairn_type();

}  // namespace cairns
