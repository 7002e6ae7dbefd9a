// The work of each system in each frame of a flight, and the functions that took it. The test flies
// again for it, so that the judged flight is not disturbed. Main thread only.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/frametest/run.hpp"
#include "engine/telemetry/work_counter.hpp"

namespace psygen::frametest {

struct ProfiledFrame {
  std::uint64_t index = 0;  // FrameRecord::index
  double time_s = 0;        // on the flight's clock
  // Of each system, in WorkUnit: the least of all flights. Waits and other programs do not count.
  std::vector<std::uint64_t> work;
};

// A function as sampled in one frame, summed over all flights.
struct FunctionSample {
  std::uint32_t frame = 0;     // position in FlightProfile::frames
  std::uint32_t function = 0;  // position in FlightProfile::functions
  std::uint32_t system = 0;    // position in FlightProfile::systems
};

struct FlightProfile {
  telemetry::WorkUnit unit = telemetry::WorkUnit::kProcessorTime;
  std::vector<std::string> systems;  // of the tick, of its steps, then kOutside
  std::vector<ProfiledFrame> frames;
  int flights = 0;
  std::vector<std::string> functions;
  std::vector<FunctionSample> samples;
  std::string no_samples;  // the reason if there are none; else empty
};

// The main thread's work outside of all systems: hooks of plugins, log, interface.
inline constexpr std::string_view kOutside = "outside of systems";

// True if frame k shows the same position and time in every flight of the test: on the virtual
// clock, and with a fixed step.
bool is_numbered(const app::FlightOptions& flight);

// Flies `flights` times and profiles each. Writes its temporary files into options.out / test.name.
// Fails with kInvalidArgument for flights that are not numbered, else like app::Flight.
core::Result<FlightProfile> profile_flight(const FrameTest& test, const RunOptions& options,
                                           const Hooks& hooks, int flights);

}  // namespace psygen::frametest
