// A picture that takes the place of a texture of the ground: checked, and brought to the textures'
// size. It reads no files (image_io.hpp) and knows nothing of kinds of ground. Pure, any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::render {

// Kinds of ground with a texture that can be replaced, in the order of world::GroundKind.
inline constexpr std::size_t kGroundPictures = 6;
// Pixels along each side of a picture.
inline constexpr std::uint32_t kMinGroundPicture = 16, kLargestGroundPicture = 4096;

// 256 × 256 texels of red, green and blue, 0 to 1 and linear, row by row. Empty: there is none.
struct GroundPicture {
  std::vector<float> rgb;
};

// `rgba`: 8 bits of each, as displayed, row by row. Fails with kInvalidArgument, and a sentence
// about the picture, if it is not square, too small or too large, has transparent pixels, is black
// in red, green or blue, or shows a seam where it is repeated.
core::Result<GroundPicture> ground_picture(std::uint32_t width, std::uint32_t height,
                                           std::span<const std::uint8_t> rgba);

}  // namespace psygen::render
