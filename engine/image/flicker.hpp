// Pixels that change and change back in pictures that follow each other: what a motion through a
// still world has little of, and what an eye sees first. For sequences of pictures at the rate at
// which they are shown. Pure; any thread.
#pragma once

#include "engine/image/image.hpp"

namespace psygen::image {

// The difference, of 255, above which two pixels count as different.
inline constexpr int kFlickerStep = 8;

// For each pixel 1 if it changes and changes back, else 0: `now` differs by more than kFlickerStep
// from `before` and from `after`, which do not differ by more from each other. The difference of
// two pixels is the greatest of their channels, without alpha. Requires valid pictures of one size.
// O(pixels).
std::vector<std::uint8_t> flickering(const Image& before, const Image& now, const Image& after);

}  // namespace psygen::image
