// Pictures from and to files. Reads PNG and JPEG (told apart by their first bytes, whatever the
// file is called); writes PNG. Files may come from strangers: sizes are checked before anything is
// allocated for them, and what the decoder reports becomes an error. OpenImageIO does the work and
// stays hidden here. Any thread; not for the tick.
#pragma once

#include <cstdint>
#include <filesystem>

#include "engine/core/error.hpp"
#include "engine/image/image.hpp"

namespace psygen::image {

struct ImageLimits {
  std::uint32_t max_width = 16384;                          // pixels
  std::uint32_t max_height = 16384;                         // pixels
  std::uint64_t max_bytes = std::uint64_t{256} << 20;       // decoded: width · height · 4
  std::uint64_t max_file_bytes = std::uint64_t{256} << 20;  // encoded
};

// Loads what reading and writing takes, 0.2 s of work, which otherwise the first picture does.
// Fails with kOutOfMemory or kInternal.
core::Result<void> load_picture_libraries();

// Any PNG or JPEG as four channels: grey is repeated, a missing alpha is 255, 16 bits become 8.
// Fails with kIo (not readable), kParse (not a picture, truncated, damaged), kOverBudget (larger
// than the limits) or kOutOfMemory; the message starts with the path.
core::Result<Image> read_image(const std::filesystem::path& path, const ImageLimits& limits = {});

// Writes into a temporary file beside `path`, flushes it to the disk and renames it, so that `path`
// holds the old picture or the new one, never a mix. Refuses to replace what is not a regular file.
// Fails with kInvalidArgument (no pixels, or bytes that do not fit the size) or kIo.
core::Result<void> write_png(const std::filesystem::path& path, const Image& image);

}  // namespace psygen::image
