#include "engine/image/flicker.hpp"

#include <algorithm>
#include <cstdlib>

#include "engine/core/assert.hpp"

namespace psygen::image {
namespace {

bool differ(const std::uint8_t* a, const std::uint8_t* b) {
  int most = 0;
  for (int channel = 0; channel < 3; ++channel)
    most = std::max(most, std::abs(a[channel] - b[channel]));
  return most > kFlickerStep;
}

}  // namespace

std::vector<std::uint8_t> flickering(const Image& before, const Image& now, const Image& after) {
  for (const Image* image : {&before, &now, &after})
    PSYGEN_CHECK(is_valid(*image) && image->width == now.width && image->height == now.height,
                 "three images of one size");
  std::vector<std::uint8_t> marks(now.rgba.size() / 4);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const std::uint8_t *a = &before.rgba[4 * i], *b = &now.rgba[4 * i], *c = &after.rgba[4 * i];
    marks[i] = differ(a, b) && differ(b, c) && !differ(a, c) ? 1 : 0;
  }
  return marks;
}

}  // namespace psygen::image
