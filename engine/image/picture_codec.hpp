// The codec of images: OpenImageIO behind a few functions, in a separate library that is loaded at
// the first read or write of an image. OpenImageIO depends on about 250 more libraries. Linked
// directly, they would cost every start 0.2 s and 100 MB; they also start threads, and terminate
// the program if they cannot. Files, limits and headers are left to image_io. Any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/image/image.hpp"
#include "engine/image/picture_header.hpp"

namespace psygen::image {

// The functions of the loaded library. Error messages have no path.
struct PictureCodec {
  // Decodes a file, whose header has been read, to four channels of 8 bits. Fails with kParse, or
  // with kInternal if OpenImageIO lacks the format.
  core::Result<Image> (*decode)(std::span<const std::uint8_t> bytes, const PictureHeader& header);
  // The same for one number of each pixel. `not_finite` stays 0.
  core::Result<NumberImage> (*decode_numbers)(std::span<const std::uint8_t> bytes,
                                              const PictureHeader& header);
  // Encodes a valid image as a PNG file. Fails with kIo, or with kInternal if OpenImageIO lacks the
  // format.
  core::Result<std::vector<std::uint8_t>> (*encode_png)(const Image& image);
  // The same for grey values, with all their bits.
  core::Result<std::vector<std::uint8_t>> (*encode_grey_png)(const GreyImage& image);
  // Encodes numbers as an OpenEXR file of 32-bit floats.
  core::Result<std::vector<std::uint8_t>> (*encode_exr)(const FloatImage& image);
};

// Checks that enough memory and threads are available to load the library. Fails with kOutOfMemory.
core::Result<void> check_room_for_codec();

// Loads the library once; it stays loaded. Fails like check_room_for_codec(), and with kInternal if
// the library is missing.
core::Result<const PictureCodec*> picture_codec();

}  // namespace psygen::image
