// The tick: everything that happens in a frame, as one list. See tick.cpp. Main thread.
#pragma once

#include "engine/scene/state.hpp"

namespace psygen::scene {

// Gives the parts of `state` to its schedule and appends the systems, in the order in which they
// run. Once per state.
void build_tick(State& state);

// The names of the systems: those of the tick in their order, then those of the simulation, as
// "step <name>".
std::vector<std::string> system_names(const State& state);

// Runs all systems once and measures each (State::system_ms). Nothing of the engine's in it fails:
// what cannot be done is counted and left for the next tick. Output::error says what ended the
// flight, if anything; also the system of a game that threw.
void tick(State& state);

}  // namespace psygen::scene
