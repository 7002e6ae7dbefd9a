// Reads the stated size of a PNG, JPEG, WebP or OpenEXR file from its first markers, without a
// decoder and without allocating, so that sizes can be rejected before any allocation for them. Not
// a validation: the rest of the file may be damaged. Pure; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace psygen::image {

// The formats that can be read; kExr as grey values only, kWebp in colour only.
enum class PictureFormat : std::uint8_t { kPng, kJpeg, kExr, kWebp };

// The stated properties of a file. Sizes in pixels, not checked against any limit.
struct PictureHeader {
  PictureFormat format = PictureFormat::kPng;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

// True if a PNG's chunks follow each other up to its end marker and match their checksums: the file
// is neither truncated nor damaged. Decoders then do not fail in ways that leak memory. O(bytes).
bool png_is_whole(std::span<const std::uint8_t> bytes);

// Nothing if the bytes have another format or end before the size, and for OpenEXR files of several
// parts or with deep pixels. O(markers).
std::optional<PictureHeader> read_picture_header(std::span<const std::uint8_t> bytes);

}  // namespace psygen::image
