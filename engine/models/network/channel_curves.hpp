// Makes the channels of a patch from its nodes: curves that never rise, that meet at one height,
// and that end in wider ones.
#pragma once

#include <cstdint>

#include "engine/models/network/patch.hpp"

namespace psygen::models::network {

// The drainage area, in nodes of the finest level, at which streams of a level get a bed. Channels
// at coarse levels are as dense as at the finest.
std::uint32_t channel_area(const Scale& scale, int level);

// How far beyond a square, in units, nodes of a level decide on the channels that reach it.
double reach_of_channels(const Scale& scale, int level);

// Adds the curves that reach a patch's square. Needs all nodes within reach_of_channels().
void add_channels(const Scale& scale, const NodePatch& nodes, Patch& patch);

}  // namespace psygen::models::network
