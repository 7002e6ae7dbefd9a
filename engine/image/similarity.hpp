// Visual similarity of two images: the mean structural similarity (SSIM) of Wang, Bovik, Sheikh and
// Simoncelli, "Image Quality Assessment: From Error Visibility to Structural Similarity" (2004).
// For comparing images of the same view; for exact differences use compare.hpp. Pure; any thread.
#pragma once

#include "engine/image/image.hpp"

namespace psygen::image {

// Side of a window, and minimum side of an image, in pixels.
inline constexpr std::uint32_t kSimilarityWindow = 8;

// 1 for equal images, lower the more they differ, at least -1. Computed on luma, 0.299 R + 0.587 G
// + 0.114 B, without alpha, in windows of 8 × 8 pixels, one every 4 pixels along both sides, with
// the paper's constants. Requires valid images of one size, at least a window wide and high.
// O(pixels).
double structural_similarity(const Image& a, const Image& b);

}  // namespace psygen::image
