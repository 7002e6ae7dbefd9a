// The pictures' decoder and encoder: OpenImageIO behind two functions. They live in a library of
// their own, which is loaded when the first picture is read or written: OpenImageIO brings some 250
// libraries along, which cost every start 0.2 s and 100 MB, start threads, and end the program
// where they do not get them. Files, limits and headers are image_io's business. Any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/image/image.hpp"
#include "engine/image/picture_header.hpp"

namespace psygen::image {

// Errors are sentences without a path.
struct PictureCodec {
  // A file whose header has been read, as 8 bits in each of four channels. Fails with kParse.
  core::Result<Image> (*decode)(std::span<const std::uint8_t> bytes, const PictureHeader& header);
  // A valid picture as a PNG file. Fails with kIo.
  core::Result<std::vector<std::uint8_t>> (*encode_png)(const Image& image);
};

// Whether the library would find the memory and the threads that it takes while it is loaded. Fails
// with kOutOfMemory.
core::Result<void> check_room_for_codec();

// Loads it, once. Fails as check_room_for_codec(), and with kInternal where the library is missing.
core::Result<const PictureCodec*> picture_codec();

}  // namespace psygen::image
