// Converts the frames of a recorded run to CSV formats of existing viewers: a log of MangoHud, or a
// capture of PresentMon 1.x, which CapFrameX reads. Values that a run does not have are 0. Converts
// all of frames.csv, including the warm-up and excluded frames. Pure; any thread.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::compare {

inline constexpr std::array<std::string_view, 2> kViewers{"mangohud", "capframex"};

// Converts the texts of frames.csv and summary.json for one of kViewers. Fails with kParse, naming
// file, line and column; `folder` is for messages.
core::Result<std::string> viewer_csv(std::string_view viewer, std::string_view frames_csv,
                                     std::string_view summary_json, const std::string& folder);

// Converts a run's folder. Also fails with kIo.
core::Result<std::string> viewer_csv(std::string_view viewer, const std::filesystem::path& folder);

}  // namespace psygen::compare
