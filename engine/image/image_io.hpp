// Reads and writes images in files. Reads PNG, JPEG, WebP, OpenEXR and TIFF (recognised by their
// first bytes, not by the name); writes PNG and OpenEXR. Files are not trusted: sizes are checked
// before any allocation for them, and errors of the decoder become errors. OpenImageIO is used only
// here. Any thread; too slow for the tick.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "engine/core/error.hpp"
#include "engine/image/image.hpp"

namespace psygen::image {

// The limits for images that read_image accepts.
struct ImageLimits {
  std::uint32_t max_width = 16384;                          // pixels
  std::uint32_t max_height = 16384;                         // pixels
  std::uint64_t max_bytes = std::uint64_t{256} << 20;       // decoded: width · height · 4
  std::uint64_t max_file_bytes = std::uint64_t{256} << 20;  // encoded
};

// Loads the libraries for reading and writing, which takes 0.2 s; otherwise the first image loads
// them. Fails with kOutOfMemory or kInternal.
core::Result<void> load_picture_libraries();

// Reads any PNG, JPEG or WebP as four channels: grey is repeated, a missing alpha is 255, 16 bits
// become 8. A JPEG is turned as its EXIF data says. Fails with kIo (not readable), kParse (not an
// image, truncated, damaged), kOverBudget (larger than the limits) or kOutOfMemory; the message
// starts with the path. Also fails like load_picture_libraries().
core::Result<Image> read_image(const std::filesystem::path& path, const ImageLimits& limits = {});
// The same for the bytes of such a file; messages call it `name`.
core::Result<Image> decode_image(std::span<const std::uint8_t> bytes,
                                 const std::filesystem::path& name, const ImageLimits& limits = {});

// Reads any PNG, JPEG, OpenEXR file of one part, or TIFF as one number per pixel: as the file
// stores it, or the mean of its colours. White is 1 for reals and for signed or 32-bit integers,
// and the largest number of other integers. Images are turned as they say. Pixels with the number
// that a GeoTIFF states for "no data" are NaN. Fails like read_image(), whose limits count 4 bytes
// per pixel.
core::Result<NumberImage> read_numbers(const std::filesystem::path& path,
                                       const ImageLimits& limits = {});
// grey_of() of read_numbers().
core::Result<GreyImage> read_grey(const std::filesystem::path& path,
                                  const ImageLimits& limits = {});

// The bytes of a PNG file with all four channels; messages call it `name`. Fails like write_png().
core::Result<std::vector<std::uint8_t>> encode_png(const std::filesystem::path& name,
                                                   const Image& image);
// Writes a temporary file next to `path`, flushes it to the disk and renames it, so `path` has the
// old image or the new one, never a mix. Never replaces anything but a regular file. Fails with
// kInvalidArgument (no pixels, more than 2^20 per side, or bytes that do not match the size) or
// kIo. Also fails like load_picture_libraries().
core::Result<void> write_png(const std::filesystem::path& path, const Image& image);
// The same for 16-bit grey values: read_grey() reads them back equal.
core::Result<void> write_png(const std::filesystem::path& path, const GreyImage& image);
// The same as OpenEXR, with all 32 bits of each value, in one channel, Y.
core::Result<void> write_exr(const std::filesystem::path& path, const FloatImage& image);

}  // namespace psygen::image
