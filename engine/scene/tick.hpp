// The tick: everything that happens in a frame, as one list. See tick.cpp. Main thread.
#pragma once

#include "engine/scene/state.hpp"

namespace psygen::scene {

// Gives the parts of `state` to its schedule and appends the systems, in the order in which they
// run. Once per state.
void build_tick(State& state);

// Runs all systems once and measures each (FrameRecord::system_ms). Nothing in it fails: what
// cannot be done is counted and left for the next tick; Output::error says what ended the flight,
// if anything.
void tick(State& state);

}  // namespace psygen::scene
