#include "engine/image/compare.hpp"

#include <algorithm>
#include <cstdlib>

#include "engine/core/assert.hpp"

namespace psygen::image {

ImageDifference compare(const Image& a, const Image& b, std::uint8_t threshold) {
  PSYGEN_CHECK(is_valid(a) && is_valid(b), "comparing a picture whose bytes do not fit its size");
  if (a.width != b.width || a.height != b.height) {
    return {false, 255, std::max(a.rgba.size(), b.rgba.size()) / 4, 1.0};
  }
  ImageDifference result{true, 0, 0, 0};
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    int largest = 0;
    for (std::size_t channel = i; channel < i + 4; ++channel) {
      largest = std::max(largest, std::abs(int{a.rgba[channel]} - int{b.rgba[channel]}));
    }
    result.max_difference = std::max(result.max_difference, static_cast<std::uint8_t>(largest));
    result.pixels_over += largest > threshold ? 1 : 0;
  }
  if (!a.rgba.empty()) {
    result.share_over =
        static_cast<double>(result.pixels_over) / static_cast<double>(a.rgba.size() / 4);
  }
  return result;
}

bool matches_golden(const ImageDifference& difference) {
  return difference.same_size && difference.share_over <= kGoldenShareAllowed;
}

}  // namespace psygen::image
