// The size that a PNG or JPEG file claims to have, read from its first markers without a decoder
// and without allocating, so that a claim can be refused before anything is made for it. Not a
// validation: the rest of the file may still be damaged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace psygen::image {

enum class PictureFormat : std::uint8_t { kPng, kJpeg };

struct PictureHeader {
  PictureFormat format = PictureFormat::kPng;
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

// True when a PNG's chunks follow each other up to its end marker and each has the checksum that it
// carries: the file is neither cut off nor damaged. Decoders then meet no surprise that leaves
// their memory behind. Linear in the size.
bool png_is_whole(std::span<const std::uint8_t> bytes);

// None when the bytes are neither format or end before the size. Linear in the number of markers.
std::optional<PictureHeader> read_picture_header(std::span<const std::uint8_t> bytes);

}  // namespace psygen::image
