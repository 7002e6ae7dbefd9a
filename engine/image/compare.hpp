// How far two pictures differ, channel by channel. For golden images: the same picture drawn by
// another driver may differ by 5/255 and, at edges, by more on at most 0.1 % of its pixels. Not a
// perceptual metric. Pure; any thread; linear in the pixels.
#pragma once

#include <cstdint>

#include "engine/core/error.hpp"
#include "engine/image/image.hpp"

namespace psygen::image {

// What a picture may differ from its golden image.
inline constexpr std::uint8_t kGoldenThreshold = 5;    // of 255
inline constexpr double kGoldenShareAllowed = 0.1e-2;  // of all pixels

// The result of a comparison.
struct ImageDifference {
  bool same_size = false;           // if false, every pixel counts as different
  std::uint8_t max_difference = 0;  // largest of any channel of any pixel, 0 … 255
  std::uint64_t pixels_over = 0;    // pixels with a channel over the threshold
  double share_over = 0;            // pixels_over / all pixels, 0 … 1

  // Equal in every field.
  friend bool operator==(const ImageDifference&, const ImageDifference&) = default;
};

// Compares two valid pictures. `threshold` is the difference of a channel, 0 … 255, that still
// counts as equal.
ImageDifference compare(const Image& a, const Image& b, std::uint8_t threshold = kGoldenThreshold);

// True for two pictures of the same size with at most 0.1 % of the pixels over the threshold.
bool matches_golden(const ImageDifference& difference);

// Where two valid pictures of one size differ, for people: `expected` dark and grey, and over it in
// yellow to red what differs by more than `threshold`; red from 64 on. Fails with kInvalidArgument
// for other sizes.
core::Result<Image> picture_of_difference(const Image& expected, const Image& seen,
                                          std::uint8_t threshold = kGoldenThreshold);

}  // namespace psygen::image
