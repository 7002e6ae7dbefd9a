// Makes the flight of a frame test with what the game adds. Main thread only.
#pragma once

#include <memory>

#include "engine/app/flight.hpp"
#include "engine/frametest/run.hpp"

namespace psygen::frametest {

// Device, stop and the hooks are added to `flight`; `last` (may be empty) comes after the game's
// plugins. Fails as Flight::create() and the hooks.
core::Result<std::unique_ptr<app::Flight>> start_flight(app::FlightOptions flight,
                                                        const RunOptions& options,
                                                        const Hooks& hooks, app::Plugin last = {});

}  // namespace psygen::frametest
