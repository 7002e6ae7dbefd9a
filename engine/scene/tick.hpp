// The tick: everything that happens in a frame, as one list. See tick.cpp. Main thread.
#pragma once

#include <span>
#include <string_view>

#include "engine/scene/state.hpp"

namespace psygen::scene {

struct System {
  std::string_view name;
  std::string_view reads;
  std::string_view writes;
  void (*run)(State&);
};

// In the order in which they run.
std::span<const System> tick_systems();

// Runs all systems once and measures each (FrameRecord::system_ms). Nothing in it fails: what
// cannot be done is counted and left for the next tick; State::error says what ended the flight, if
// anything.
void tick(State& state);

}  // namespace psygen::scene
