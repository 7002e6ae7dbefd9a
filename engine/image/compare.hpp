// Compares images: channel by channel for golden images, by flicker, and by visual similarity.
// Pure; any thread; linear in the pixels.
#pragma once

#include <cstdint>

#include "engine/core/error.hpp"
#include "engine/image/image.hpp"

namespace psygen::image {

// The allowed difference of an image from its golden image, on the same driver.
inline constexpr std::uint8_t kGoldenThreshold = 5;    // of 255
inline constexpr double kGoldenShareAllowed = 0.1e-2;  // fraction of all pixels
// On another driver, which rounds otherwise and moves edges: mean of all channels of the image, and
// of a tile, of 255.
inline constexpr double kOtherDriverMean = 1, kOtherDriverTile = 8;
inline constexpr std::uint32_t kTileSide = 16;  // pixels

// The result of a comparison.
struct ImageDifference {
  bool same_size = false;           // if false, every pixel counts as different
  std::uint8_t max_difference = 0;  // largest of any channel of any pixel, 0 … 255
  std::uint64_t pixels_over = 0;    // pixels with a channel over the threshold
  double share_over = 0;            // pixels_over / all pixels, 0 … 1
  double mean = 0;                  // of red, green and blue of all pixels, 0 … 255
  double worst_tile = 0;            // the largest mean of a tile; edges cut tiles

  // Equal in every field.
  friend bool operator==(const ImageDifference&, const ImageDifference&) = default;
};

// Compares two valid images. `threshold` is the channel difference, 0 … 255, that still counts as
// equal.
ImageDifference compare(const Image& a, const Image& b, std::uint8_t threshold = kGoldenThreshold);

// True if two images have the same size and at most 0.1 % of the pixels over the threshold.
bool matches_golden(const ImageDifference& difference);

// True if two images have the same size and differ by at most kOtherDriverMean, and in no tile by
// more than kOtherDriverTile.
bool matches_other_driver(const ImageDifference& difference);

// Shows the differences of two valid images of one size: `expected` in dark grey, and over it, from
// yellow to red, the pixels that differ by more than `threshold`; red from 64 on. Fails with
// kInvalidArgument for different sizes.
core::Result<Image> picture_of_difference(const Image& expected, const Image& seen,
                                          std::uint8_t threshold = kGoldenThreshold);

}  // namespace psygen::image
