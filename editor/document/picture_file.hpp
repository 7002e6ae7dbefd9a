// A picture of a world as a PNG file with 16 bits. The only place of the editor that writes them.
#pragma once

#include <filesystem>

#include "engine/core/error.hpp"
#include "engine/world/mask.hpp"

namespace psygen::editor {

// Replaces the file as a whole. Fails with kIo; the message starts with the path.
core::Result<void> write_picture_file(const std::filesystem::path& file,
                                      const world::GreyPicture& picture);

}  // namespace psygen::editor
