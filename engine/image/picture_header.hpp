// Reads the stated size of a PNG, JPEG, WebP, OpenEXR or TIFF file from its markers, without a
// decoder, so that sizes can be rejected before any allocation for them. Not a validation: the rest
// of the file may be damaged. Pure; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "engine/core/error.hpp"

namespace psygen::image {

// The formats that can be read; kExr and kTiff as numbers only, kWebp in colour only.
enum class PictureFormat : std::uint8_t { kPng, kJpeg, kExr, kTiff, kWebp };

// The stated properties of a file. Sizes in pixels, not checked against any limit.
struct PictureHeader {
  PictureFormat format = PictureFormat::kPng;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::optional<double> no_data = {};  // the number of pixels without data (TIFF); may be NaN
};

// True if a PNG's chunks follow each other up to its end marker and match their checksums: the file
// is neither truncated nor damaged. Decoders then do not fail in ways that leak memory. O(bytes).
bool png_is_whole(std::span<const std::uint8_t> bytes);

// Fails with kParse if the bytes have another format or end before the size, and for OpenEXR and
// TIFF files that no decoder of this program reads; messages have no path. O(markers).
core::Result<PictureHeader> read_picture_header(std::span<const std::uint8_t> bytes);

// The same for a TIFF or BigTIFF file: its first image, in strips or tiles that lie in the file,
// are no larger than the image needs and use a compression whose memory they bound.
core::Result<PictureHeader> read_tiff_header(std::span<const std::uint8_t> bytes);

}  // namespace psygen::image
