#include "engine/image/similarity.hpp"

#include <algorithm>

#include "engine/core/assert.hpp"

namespace psygen::image {
namespace {

constexpr std::uint32_t kStep = 4;
constexpr double kC1 = (0.01 * 255) * (0.01 * 255), kC2 = (0.03 * 255) * (0.03 * 255);

std::vector<float> luma_of(const Image& image) {
  std::vector<float> luma(image.rgba.size() / 4);
  for (std::size_t i = 0; i < luma.size(); ++i) {
    const std::uint8_t* const pixel = &image.rgba[4 * i];
    luma[i] = 0.299F * static_cast<float>(pixel[0]) + 0.587F * static_cast<float>(pixel[1]) +
              0.114F * static_cast<float>(pixel[2]);
  }
  return luma;
}

// The similarity of the windows that start at these pixels.
double similarity_of(const float* a, const float* b, std::size_t width) {
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

}  // namespace

double structural_similarity(const Image& a, const Image& b) {
  PSYGEN_CHECK(is_valid(a) && is_valid(b) && a.width == b.width && a.height == b.height,
               "two images of one size");
  PSYGEN_CHECK(std::min(a.width, a.height) >= kSimilarityWindow, "a window fits");
  const std::vector<float> luma_a = luma_of(a), luma_b = luma_of(b);
  double sum = 0;
  std::size_t count = 0;
  for (std::uint32_t y = 0; y + kSimilarityWindow <= a.height; y += kStep) {
    for (std::uint32_t x = 0; x + kSimilarityWindow <= a.width; x += kStep, ++count) {
      const std::size_t at = std::size_t{y} * a.width + x;
      sum += similarity_of(&luma_a[at], &luma_b[at], a.width);
    }
  }
  return sum / static_cast<double>(count);
}

}  // namespace psygen::image
