// The texture behind the clouds: 256 × 256, two half floats a texel, repeating (lavapipe filters
// them faster than bytes). Made once at start-up.
#pragma once

#include <cstdint>
#include <vector>

namespace psygen::render {

inline constexpr std::uint32_t kCloudTextureSize = 256;

// Red: density of fractal noise, spread over 0 to 1. Green: light from one side (a relief of it).
std::vector<std::uint16_t> make_cloud_texture();

}  // namespace psygen::render
