// How alike two pictures look: the mean structural similarity (SSIM) of Wang, Bovik, Sheikh and
// Simoncelli, "Image Quality Assessment: From Error Visibility to Structural Similarity" (2004).
// For comparing pictures of the same view; where bits count there is compare.hpp. Pure; any thread.
#pragma once

#include "engine/image/image.hpp"

namespace psygen::image {

// Side of a window, and the least side of a picture, in pixels.
inline constexpr std::uint32_t kSimilarityWindow = 8;

// 1 for equal pictures, less the less alike they are, at least -1. Of the luma, 0.299 R + 0.587 G +
// 0.114 B, without alpha, in windows of 8 × 8 pixels, one every 4 pixels along both sides; the
// constants are those of the paper. Requires valid pictures of one size, at least a window wide and
// high. O(pixels).
double structural_similarity(const Image& a, const Image& b);

}  // namespace psygen::image
