// Reads and writes path files: TOML text to CameraPath and back. Pure apart from reading the file,
// any thread. Format: docs/world-files.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/world/camera_path.hpp"

namespace psygen::world {

inline constexpr int kPathFormat = 1;  // version of the format

// Reads a path file. Fails with kParse for texts that are not path files, naming file, line and
// field; with kIo and kOverBudget like load_world().
core::Result<CameraPath> load_camera_path(const std::filesystem::path& file);

// The same for a text in memory; `file_name` is for messages only.
core::Result<CameraPath> parse_camera_path(std::string_view text, std::string_view file_name);

// The text of a path file from which parse_camera_path() makes an equal path.
std::string write_camera_path(const CameraPath& path);

}  // namespace psygen::world
