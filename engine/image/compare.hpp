// How far two pictures are apart, channel by channel. For golden images: the same picture drawn by
// another driver may differ by 5/255 and, at edges, by more on at most 0.1 % of its pixels.
// Not a perceptual metric.
#pragma once

#include <cstdint>

#include "engine/image/image.hpp"

namespace psygen::image {

inline constexpr std::uint8_t kGoldenThreshold = 5;    // of 255
inline constexpr double kGoldenShareAllowed = 0.1e-2;  // of all pixels

struct ImageDifference {
  bool same_size = false;           // when false, every pixel counts as different
  std::uint8_t max_difference = 0;  // largest difference of any channel of any pixel, 0 … 255
  std::uint64_t pixels_over = 0;    // pixels with a channel that differs by more than the threshold
  double share_over = 0;            // pixels_over / all pixels, 0 … 1

  friend bool operator==(const ImageDifference&, const ImageDifference&) = default;
};

ImageDifference compare(const Image& a, const Image& b, std::uint8_t threshold = kGoldenThreshold);

// True for two pictures of one size with at most 0.1 % of the pixels over the threshold.
bool matches_golden(const ImageDifference& difference);

}  // namespace psygen::image
