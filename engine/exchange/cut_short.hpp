// Detects files from write_scene() that are truncated, for example because a disk was full while
// they were copied. It does not detect damage within a file. Any thread; reads a whole .obj, but
// only the head of a .glb.
#pragma once

#include <filesystem>
#include <string_view>

#include "engine/exchange/write_document.hpp"

namespace psygen::exchange {

// True if `path` is empty, or starts like such a file but is truncated (a .glb: shorter than its
// header states). Also true for the .obj of a document of this name whose .mtl is missing or empty.
// False for a whole file, even with additions to it or to its materials, and for a file that starts
// differently, does not exist or cannot be read.
bool is_cut_short(const std::filesystem::path& path, Format format, std::string_view document_name);

}  // namespace psygen::exchange
