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

// Adds the mean differences of the image and of its worst tile. Both images have one size.
void add_means(const Image& a, const Image& b, ImageDifference& result) {
  const std::size_t columns = (a.width + kTileSide - 1) / kTileSide;
  const std::size_t rows = (a.height + kTileSide - 1) / kTileSide;
  std::vector<std::uint64_t> sums(columns * rows);
  for (std::size_t y = 0, i = 0; y < a.height; ++y) {
    std::uint64_t* const row = &sums[y / kTileSide * columns];
    for (std::size_t x = 0; x < a.width; ++x, i += 4)
      for (std::size_t channel = i; channel < i + 3; ++channel)
        row[x / kTileSide] +=
            static_cast<std::uint64_t>(std::abs(int{a.rgba[channel]} - int{b.rgba[channel]}));
  }
  const auto side = [](std::size_t pixels, std::size_t tile) {
    return std::min<std::size_t>(kTileSide, pixels - tile * kTileSide);
  };
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const std::size_t pixels = side(a.width, i % columns) * side(a.height, i / columns);
    const auto sum = static_cast<double>(sums[i]);
    result.worst_tile = std::max(result.worst_tile, sum / static_cast<double>(3 * pixels));
    result.mean += sum / (3.0 * a.width * a.height);
  }
}

}  // namespace

ImageDifference compare(const Image& a, const Image& b, std::uint8_t threshold) {
  PSYGEN_CHECK(is_valid(a) && is_valid(b), "the bytes of an image must match its size");
  if (a.width != b.width || a.height != b.height) {
    return {.max_difference = 255,
            .pixels_over = std::max(a.rgba.size(), b.rgba.size()) / 4,
            .share_over = 1,
            .mean = 255,
            .worst_tile = 255};
  }
  ImageDifference result{.same_size = true};
  for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
    const int largest = difference_of(a, b, i);
    result.max_difference = std::max(result.max_difference, static_cast<std::uint8_t>(largest));
    result.pixels_over += largest > threshold ? 1 : 0;
  }
  if (!a.rgba.empty()) {
    result.share_over =
        static_cast<double>(result.pixels_over) / static_cast<double>(a.rgba.size() / 4);
  }
  add_means(a, b, result);
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

bool matches_other_driver(const ImageDifference& difference) {
  return difference.same_size && difference.mean <= kOtherDriverMean &&
         difference.worst_tile <= kOtherDriverTile;
}

}  // namespace psygen::image
