// Tells a file that write_document() wrote and that lost its end since, as when a disk was full
// while it was copied, from a whole one. Damage within a file is not seen.
#pragma once

#include <filesystem>
#include <string_view>

#include "engine/exchange/write_document.hpp"

namespace psygen::exchange {

// Whether `path` is empty, or begins as such a file and lacks its end (of a .glb: is shorter than
// it says), or is the .obj of a document of this name whose .mtl is missing or empty. False for a
// whole file, whatever was added to it or to its materials, for one that does not begin like that,
// and for what does not exist or cannot be read. Any thread.
bool is_cut_short(const std::filesystem::path& path, Format format, std::string_view document_name);

}  // namespace psygen::exchange
