// Tells a file that write_document() wrote and that lost its end since (a full disk while it was
// copied, a damaged file system) from a whole one. Looks at the first and last bytes only.
#pragma once

#include <filesystem>
#include <string_view>

#include "engine/exchange/write_document.hpp"

namespace psygen::exchange {

// Whether `path` begins as the file of a document of this name and lacks its end, or the .mtl that
// belongs to it, or is empty. False for a whole file, for what another program wrote, and for what
// does not exist or cannot be read. Any thread.
bool is_cut_short(const std::filesystem::path& path, Format format, std::string_view document_name);

}  // namespace psygen::exchange
