#include "engine/image/compare.hpp"

#include <algorithm>
#include <cstdlib>

#include "engine/core/assert.hpp"

namespace psygen::image {
namespace {

// The largest channel difference of the pixel whose first byte is `at`.
int difference_of(const Image& a, const Image& b, std::size_t at) {
  int largest = 0;
  for (std::size_t channel = at; channel < at + 4; ++channel)
    largest = std::max(largest, std::abs(int{a.rgba[channel]} - int{b.rgba[channel]}));
  return largest;
}

}  // namespace

ImageDifference compare(const Image& a, const Image& b, std::uint8_t threshold) {
  PSYGEN_CHECK(is_valid(a) && is_valid(b), "the bytes of an image must match its size");
  if (a.width != b.width || a.height != b.height) {
    return {false, 255, std::max(a.rgba.size(), b.rgba.size()) / 4, 1.0};
  }
  ImageDifference result{true, 0, 0, 0};
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    const int largest = difference_of(a, b, i);
    result.max_difference = std::max(result.max_difference, static_cast<std::uint8_t>(largest));
    result.pixels_over += largest > threshold ? 1 : 0;
  }
  if (!a.rgba.empty()) {
    result.share_over =
        static_cast<double>(result.pixels_over) / static_cast<double>(a.rgba.size() / 4);
  }
  return result;
}

core::Result<Image> picture_of_difference(const Image& expected, const Image& seen,
                                          std::uint8_t threshold) {
  PSYGEN_CHECK(is_valid(expected) && is_valid(seen), "the bytes of an image must match its size");
  if (expected.width != seen.width || expected.height != seen.height)
    return core::fail(core::ErrorCode::kInvalidArgument, "the images have different sizes");
  constexpr int kGreyShare = 5, kFull = 64;  // grey is a fifth of the mean of the channels
  Image image = expected;
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    const int difference = difference_of(expected, seen, i);
    const int grey =
        (expected.rgba[i] + expected.rgba[i + 1] + expected.rgba[i + 2]) / (3 * kGreyShare);
    const bool differs = difference > threshold;
    const int green = 230 - 230 * std::min(difference, kFull) / kFull;
    image.rgba[i] = static_cast<std::uint8_t>(differs ? 255 : grey);
    image.rgba[i + 1] = static_cast<std::uint8_t>(differs ? green : grey);
    image.rgba[i + 2] = static_cast<std::uint8_t>(differs ? 0 : grey);
    image.rgba[i + 3] = 255;
  }
  return image;
}

bool matches_golden(const ImageDifference& difference) {
  return difference.same_size && difference.share_over <= kGoldenShareAllowed;
}

}  // namespace psygen::image
