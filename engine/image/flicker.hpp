// Finds flicker: pixels that change and change back in successive images. A motion through a still
// world has little flicker, and viewers notice it first. For image sequences at their display rate.
// Pure; any thread.
#pragma once

#include "engine/image/image.hpp"

namespace psygen::image {

// The channel difference, of 255, above which two pixels count as different.
inline constexpr int kFlickerStep = 8;

// 1 for each pixel that changes and changes back, else 0: `now` differs by more than kFlickerStep
// from `before` and from `after`, which do not differ by more from each other. The difference of
// two pixels is the maximum over their channels, without alpha. Requires valid images of one size.
// O(pixels).
std::vector<std::uint8_t> flickering(const Image& before, const Image& now, const Image& after);

}  // namespace psygen::image
