// Path files: TOML text to CameraPath (docs/world-files.md).
#pragma once

#include <filesystem>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/world/camera_path.hpp"

namespace psygen::world {

inline constexpr int kPathFormat = 1;

// Reads a path file. kParse for texts that are no path file (naming file, line and field), kIo and
// kOverBudget as load_world().
core::Result<CameraPath> load_camera_path(const std::filesystem::path& file);

// The same for a text in memory; `file_name` is for messages only.
core::Result<CameraPath> parse_camera_path(std::string_view text, std::string_view file_name);

}  // namespace psygen::world
