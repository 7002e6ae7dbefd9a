// An image in memory: 8 bits per channel, red, green, blue, alpha, rows from top to bottom without
// padding. A plain value: no files (image_io.hpp), no colour management (bytes are sRGB as stored,
// alpha is not premultiplied). Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace psygen::image {

// An image. Valid if `rgba` has width · height · 4 bytes.
struct Image {
  std::uint32_t width = 0;         // pixels
  std::uint32_t height = 0;        // pixels
  std::vector<std::uint8_t> rgba;  // width · height · 4

  // The four bytes of a pixel. Requires x < width and y < height. O(1).
  std::span<const std::uint8_t, 4> pixel(std::uint32_t x, std::uint32_t y) const;
  std::span<std::uint8_t, 4> pixel(std::uint32_t x, std::uint32_t y);

  // Equal in size and in every byte.
  friend bool operator==(const Image&, const Image&) = default;
};

// A greyscale image with 16 bits, such as masks and heights; no colour management. Valid if `grey`
// has width · height values.
struct GreyImage {
  std::uint32_t width = 0;          // pixels
  std::uint32_t height = 0;         // pixels
  std::vector<std::uint16_t> grey;  // 0 … 65535
};

// An image with one number per pixel, such as heights in metres. Valid if `values` has width ·
// height values.
struct FloatImage {
  std::uint32_t width = 0;    // pixels
  std::uint32_t height = 0;   // pixels
  std::vector<float> values;  // any
};

// The numbers of an image as its file stores them, such as heights in metres: the mean of its
// colours if it has several. Valid if `values` has width · height values, and `alpha` none or as
// many.
struct NumberImage {
  std::uint32_t width = 0;        // pixels
  std::uint32_t height = 0;       // pixels
  std::vector<float> values;      // NaN: the pixel has no number
  std::vector<float> alpha;       // 0 transparent … 1 opaque; empty: all opaque
  bool is_premultiplied = false;  // values are multiplied by alpha already
  bool is_coloured = false;       // the colours of some pixel differ
  double white = 1;               // the number of white; 0 is black
  std::uint64_t not_finite = 0;   // pixels that were NaN or infinite, and are NaN now
};

// The least and the largest number of an image; the least is above the largest if it has none.
struct NumberRange {
  float least = 0, largest = 0;
};
NumberRange range_of(std::span<const float> numbers);

// Grey values from 0 (black) to `white`, times alpha. Numbers beyond become black or white, and NaN
// becomes black.
GreyImage grey_of(const NumberImage& image);

// An image of one colour (transparent black by default). Sizes in pixels, channels 0 … 255.
Image make_image(std::uint32_t width, std::uint32_t height, std::uint8_t red = 0,
                 std::uint8_t green = 0, std::uint8_t blue = 0, std::uint8_t alpha = 0);

// True if the size of `rgba` matches width and height.
bool is_valid(const Image& image);

// A hash of the size and of every byte; the same on every machine. O(bytes).
std::uint64_t hash(const Image& image);

}  // namespace psygen::image
