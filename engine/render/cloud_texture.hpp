// The texture behind the clouds: 256 × 256, two bytes a texel, repeating. Made once at start-up.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace psygen::render {

inline constexpr std::uint32_t kCloudTextureSize = 256;

// Red: density of fractal noise, spread over 0 … 255. Green: light from one side (a relief of it).
std::vector<std::byte> make_cloud_texture();

}  // namespace psygen::render
