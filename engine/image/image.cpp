#include "engine/image/image.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/assert.hpp"
#include "engine/core/hash.hpp"

namespace psygen::image {
namespace {

std::size_t offset_of(const Image& image, std::uint32_t x, std::uint32_t y) {
  PSYGEN_ASSERT(x < image.width && y < image.height, "the pixel is in the image");
  return (std::size_t{y} * image.width + x) * 4;
}

}  // namespace

std::span<const std::uint8_t, 4> Image::pixel(std::uint32_t x, std::uint32_t y) const {
  return std::span<const std::uint8_t, 4>(rgba.data() + offset_of(*this, x, y), 4);
}

std::span<std::uint8_t, 4> Image::pixel(std::uint32_t x, std::uint32_t y) {
  return std::span<std::uint8_t, 4>(rgba.data() + offset_of(*this, x, y), 4);
}

NumberRange range_of(std::span<const float> numbers) {
  constexpr float kEnd = std::numeric_limits<float>::infinity();
  NumberRange range{kEnd, -kEnd};
  for (const float number : numbers) {
    if (std::isnan(number)) continue;
    range.least = std::min(range.least, number);
    range.largest = std::max(range.largest, number);
  }
  return range;
}

GreyImage grey_of(const NumberImage& image) {
  GreyImage grey{image.width, image.height, {}};
  grey.grey.reserve(image.values.size());
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    double share = double{image.values[i]} / image.white;
    if (!image.alpha.empty() && !image.is_premultiplied) share *= double{image.alpha[i]};
    share = share > 0 ? std::min(share, 1.0) : 0;  // NaN is black
    grey.grey.push_back(static_cast<std::uint16_t>(share * 65535 + 0.5));
  }
  return grey;
}

Image make_image(std::uint32_t width, std::uint32_t height, std::uint8_t red, std::uint8_t green,
                 std::uint8_t blue, std::uint8_t alpha) {
  Image image{width, height, std::vector<std::uint8_t>(std::size_t{width} * height * 4)};
  for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
    image.rgba[i] = red;
    image.rgba[i + 1] = green;
    image.rgba[i + 2] = blue;
    image.rgba[i + 3] = alpha;
  }
  return image;
}

bool is_valid(const Image& image) {
  return image.rgba.size() == std::size_t{image.width} * image.height * 4;
}

std::uint64_t hash(const Image& image) {
  const std::uint64_t size = (std::uint64_t{image.width} << 32) | image.height;
  return core::combine(core::hash_bytes(std::as_bytes(std::span(image.rgba))), size);
}

}  // namespace psygen::image
