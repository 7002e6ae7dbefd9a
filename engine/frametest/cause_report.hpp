// The causes of the bad frames of a failed test, and those of the difference to its base: for the
// page of the failure and in one line each. Main thread only.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/frametest/cause.hpp"
#include "engine/frametest/failure.hpp"

namespace psygen::frametest {

// In the folder of a test.
inline constexpr const char* kProfileFile = "profile.json";

struct CauseReport {
  std::string base_html = {};                 // the comparison with the base
  std::vector<std::string> frames_html = {};  // of each frame
  std::vector<std::string> lines = {};        // "frame 112: 'step paths' took …"
  std::vector<std::string> missing = {};      // what cannot be had, with the reason
};

// Profiles the test in three flights, in one if a flight takes over a minute, and writes
// profile.json into options.out / test.name. `base` is the folder of a base with a profile.json, or
// empty. Causes are missing if frames are not numbered, if the base has no profile, and if a flight
// fails.
CauseReport find_causes(const FrameTest& test, std::span<const WorstFrame> frames,
                        const std::filesystem::path& base, double flight_s,
                        const RunOptions& options, const Hooks& hooks);

}  // namespace psygen::frametest
