// Reads and writes path files: TOML text to CameraPath and back. Pure, except for reading the file;
// any thread. Format: docs/world-files.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "engine/core/error.hpp"
#include "engine/world/camera_path.hpp"

namespace psygen::world {

inline constexpr int kPathFormat = 1;  // version of the format

// Reads a path file. Fails with kParse, naming file, line and field, if the text is not a path
// file; with kIo and kOverBudget like load_world().
core::Result<CameraPath> load_camera_path(const std::filesystem::path& file);

// The same for a text in memory; `file_name` appears in messages only.
core::Result<CameraPath> parse_camera_path(std::string_view text, std::string_view file_name);

// The text of a path file that parse_camera_path() reads back as an equal path.
std::string write_camera_path(const CameraPath& path);

}  // namespace psygen::world
