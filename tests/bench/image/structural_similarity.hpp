// Visual similarity: the mean structural similarity (SSIM) of Wang, Bovik, Sheikh and Simoncelli,
// "Image Quality Assessment: From Error Visibility to Structural Similarity" (2004). For images of
// the same view.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/core/assert.hpp"
#include "engine/image/image.hpp"

namespace psygen::bench {

// Side of a window, and minimum side of an image, in pixels.
inline constexpr std::uint32_t kSimilarityWindow = 8;
inline constexpr std::uint32_t kSimilarityStep = 4;
inline constexpr double kC1 = (0.01 * 255) * (0.01 * 255), kC2 = (0.03 * 255) * (0.03 * 255);

inline std::vector<float> luma_of(const image::Image& image) {
  std::vector<float> luma(image.rgba.size() / 4);
  for (std::size_t i = 0; i < luma.size(); ++i) {
    const std::uint8_t* const pixel = &image.rgba[4 * i];
    luma[i] = 0.299F * static_cast<float>(pixel[0]) + 0.587F * static_cast<float>(pixel[1]) +
              0.114F * static_cast<float>(pixel[2]);
  }
  return luma;
}

// The similarity of the windows that start at these pixels.
inline double similarity_of(const float* a, const float* b, std::size_t width) {
  double sum_a = 0, sum_b = 0, sum_aa = 0, sum_bb = 0, sum_ab = 0;
  for (std::size_t y = 0; y < kSimilarityWindow; ++y) {
    for (std::size_t x = 0; x < kSimilarityWindow; ++x) {
      const double p = double{a[y * width + x]}, q = double{b[y * width + x]};
      sum_a += p;
      sum_b += q;
      sum_aa += p * p;
      sum_bb += q * q;
      sum_ab += p * q;
    }
  }
  constexpr double kCount = kSimilarityWindow * kSimilarityWindow;
  const double mean_a = sum_a / kCount, mean_b = sum_b / kCount;
  const double variance_a = std::max(sum_aa / kCount - mean_a * mean_a, 0.0);
  const double variance_b = std::max(sum_bb / kCount - mean_b * mean_b, 0.0);
  const double covariance = sum_ab / kCount - mean_a * mean_b;
  return (2 * mean_a * mean_b + kC1) * (2 * covariance + kC2) /
         ((mean_a * mean_a + mean_b * mean_b + kC1) * (variance_a + variance_b + kC2));
}

// 1 for equal images, lower the more they differ, at least -1. Computed on luma, 0.299 R + 0.587 G
// + 0.114 B, without alpha, in windows of 8 × 8 pixels, one every 4 pixels along both sides, with
// the paper's constants. Requires valid images of one size, at least a window wide and high.
// O(pixels).
inline double structural_similarity(const image::Image& a, const image::Image& b) {
  PSYGEN_CHECK(
      image::is_valid(a) && image::is_valid(b) && a.width == b.width && a.height == b.height,
      "two images of one size");
  PSYGEN_CHECK(std::min(a.width, a.height) >= kSimilarityWindow, "a window fits");
  const std::vector<float> luma_a = luma_of(a), luma_b = luma_of(b);
  double sum = 0;
  std::size_t count = 0;
  for (std::uint32_t y = 0; y + kSimilarityWindow <= a.height; y += kSimilarityStep) {
    for (std::uint32_t x = 0; x + kSimilarityWindow <= a.width; x += kSimilarityStep, ++count) {
      const std::size_t at = std::size_t{y} * a.width + x;
      sum += similarity_of(&luma_a[at], &luma_b[at], a.width);
    }
  }
  return sum / static_cast<double>(count);
}

}  // namespace psygen::bench
