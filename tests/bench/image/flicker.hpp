// Flicker: pixels that change and change back in successive images. A motion through a still world
// has little flicker, and viewers notice it first. For image sequences at their display rate.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "engine/core/assert.hpp"
#include "engine/image/image.hpp"

namespace psygen::bench {

// The channel difference, of 255, above which two pixels count as different.
inline constexpr int kFlickerStep = 8;

inline bool differ(const std::uint8_t* a, const std::uint8_t* b) {
  int most = 0;
  for (int channel = 0; channel < 3; ++channel)
    most = std::max(most, std::abs(a[channel] - b[channel]));
  return most > kFlickerStep;
}

// 1 for each pixel that changes and changes back, else 0: `now` differs by more than kFlickerStep
// from `before` and from `after`, which do not differ by more from each other. The difference of
// two pixels is the maximum over their channels, without alpha. Requires valid images of one size.
// O(pixels).
inline std::vector<std::uint8_t> flickering(const image::Image& before, const image::Image& now,
                                            const image::Image& after) {
  for (const image::Image* image : {&before, &now, &after})
    PSYGEN_CHECK(
        image::is_valid(*image) && image->width == now.width && image->height == now.height,
        "three images of one size");
  std::vector<std::uint8_t> marks(now.rgba.size() / 4);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const std::uint8_t *a = &before.rgba[4 * i], *b = &now.rgba[4 * i], *c = &after.rgba[4 * i];
    marks[i] = differ(a, b) && differ(b, c) && !differ(a, c) ? 1 : 0;
  }
  return marks;
}

}  // namespace psygen::bench
