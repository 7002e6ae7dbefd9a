// The frames of a recorded run in CSV formats that existing viewers read: a log of MangoHud, and a
// capture of PresentMon 1.x, which CapFrameX reads. What a run does not know is 0 there. Reads
// frames.csv as it is, the warm-up and frames that are set apart too. Pure; any thread.
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

// The texts of frames.csv and summary.json as one of the formats. Fails with kParse, naming file,
// line and column; `folder` is for messages.
core::Result<std::string> viewer_csv(Viewer viewer, std::string_view frames_csv,
                                     std::string_view summary_json, const std::string& folder);

// The same of a run's folder. Fails also with kIo.
core::Result<std::string> viewer_csv(Viewer viewer, const std::filesystem::path& folder);

}  // namespace psygen::compare
