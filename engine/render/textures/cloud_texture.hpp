// The cloud texture: 256 × 256, two half floats per texel (lavapipe filters them faster than
// bytes), repeating. Computed once at start-up. Pure; it makes no Vulkan image
// (frame/frame_sets.cpp).
#pragma once

#include <cstdint>
#include <vector>

namespace psygen::render {

inline constexpr std::uint32_t kCloudTextureSize = 256;  // texels per side

// The texels, row by row, both scaled to 0 … 1. Red: density of clouds, fractal noise with round
// billows. Green: fractal noise, as many texels of each value as red has; waves and foam use it
// too.
std::vector<std::uint16_t> make_cloud_texture();

}  // namespace psygen::render
