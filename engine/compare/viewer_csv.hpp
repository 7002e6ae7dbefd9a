// Converts the frames of a recorded run to CSV formats of existing viewers: a log of MangoHud, or a
// capture of PresentMon 1.x, which CapFrameX reads. Values that a run does not have are 0. Converts
// all of frames.csv, including the warm-up and excluded frames. Pure; any thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"

namespace psygen::compare {

enum class Viewer : std::uint8_t { kMangoHud, kCapFrameX };
// "mangohud", "capframex".
std::optional<Viewer> viewer_from(std::string_view name);

// Converts the texts of frames.csv and summary.json. Fails with kParse, naming file, line and
// column; `folder` is for messages.
core::Result<std::string> viewer_csv(Viewer viewer, std::string_view frames_csv,
                                     std::string_view summary_json, const std::string& folder);

// Converts a run's folder. Also fails with kIo.
core::Result<std::string> viewer_csv(Viewer viewer, const std::filesystem::path& folder);

}  // namespace psygen::compare
