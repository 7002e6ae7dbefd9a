// Compares two images channel by channel. For golden images: the same image from another driver may
// differ by 5/255 and, at edges, by more on at most 0.1 % of its pixels. Not a perceptual metric.
// Pure; any thread; linear in the pixels.
#pragma once

#include <cstdint>

#include "engine/core/error.hpp"
#include "engine/image/image.hpp"

namespace psygen::image {

// The allowed difference of an image from its golden image.
inline constexpr std::uint8_t kGoldenThreshold = 5;    // of 255
inline constexpr double kGoldenShareAllowed = 0.1e-2;  // fraction of all pixels

// The result of a comparison.
struct ImageDifference {
  bool same_size = false;           // if false, every pixel counts as different
  std::uint8_t max_difference = 0;  // largest of any channel of any pixel, 0 … 255
  std::uint64_t pixels_over = 0;    // pixels with a channel over the threshold
  double share_over = 0;            // pixels_over / all pixels, 0 … 1

  // Equal in every field.
  friend bool operator==(const ImageDifference&, const ImageDifference&) = default;
};

// Compares two valid images. `threshold` is the channel difference, 0 … 255, that still counts as
// equal.
ImageDifference compare(const Image& a, const Image& b, std::uint8_t threshold = kGoldenThreshold);

// True if two images have the same size and at most 0.1 % of the pixels over the threshold.
bool matches_golden(const ImageDifference& difference);

// Shows the differences of two valid images of one size: `expected` in dark grey, and over it, from
// yellow to red, the pixels that differ by more than `threshold`; red from 64 on. Fails with
// kInvalidArgument for different sizes.
core::Result<Image> picture_of_difference(const Image& expected, const Image& seen,
                                          std::uint8_t threshold = kGoldenThreshold);

}  // namespace psygen::image
