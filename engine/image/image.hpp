// A picture in memory: 8 bits per channel, red, green, blue, alpha, rows from top to bottom without
// padding. A plain value: no files (image_io.hpp), no colour management (bytes are sRGB as stored,
// alpha is not premultiplied).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace psygen::image {

struct Image {
  std::uint32_t width = 0;         // pixels
  std::uint32_t height = 0;        // pixels
  std::vector<std::uint8_t> rgba;  // width · height · 4

  // The four bytes of a pixel. Requires x < width and y < height.
  std::span<const std::uint8_t, 4> pixel(std::uint32_t x, std::uint32_t y) const;
  std::span<std::uint8_t, 4> pixel(std::uint32_t x, std::uint32_t y);

  friend bool operator==(const Image&, const Image&) = default;
};

// A picture of one colour (transparent black when none is given).
Image make_image(std::uint32_t width, std::uint32_t height, std::uint8_t red = 0,
                 std::uint8_t green = 0, std::uint8_t blue = 0, std::uint8_t alpha = 0);

// True when the size of `rgba` is what width and height say.
bool is_valid(const Image& image);

// Hash of the size and of every byte; the same on every machine.
std::uint64_t hash(const Image& image);

}  // namespace psygen::image
