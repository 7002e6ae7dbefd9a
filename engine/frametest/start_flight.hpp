// Creates the flight of a frame test with the game's hooks. Main thread only.
#pragma once

#include <memory>

#include "engine/app/flight.hpp"
#include "engine/frametest/run.hpp"

namespace psygen::frametest {

// Adds device, stop flag and hooks to `flight`; `last` (may be empty) follows the game's plugins.
// Fails like Flight::create() and the hooks.
core::Result<std::unique_ptr<app::Flight>> start_flight(app::FlightOptions flight,
                                                        const RunOptions& options,
                                                        const Hooks& hooks, app::Plugin last = {});

}  // namespace psygen::frametest
