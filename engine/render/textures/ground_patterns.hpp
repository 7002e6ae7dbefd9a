// Patterns that repeat, from which the materials of the ground are made: fields of numbers over a
// square whose borders join, noise, cells, strokes and gradients of height. Deterministic: single
// precision, counter-based random numbers, and no library function but the square root. Pure, any
// thread. It knows no material and no Vulkan (ground_textures.hpp). Private to engine/render.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace psygen::render {

inline constexpr int kPatternSide = 256;  // texels per side, a power of two

// One number for each texel, row by row.
struct Field {
  std::vector<float> values = std::vector<float>(std::size_t{kPatternSide} * kPatternSide);

  // The number at any place; the square repeats.
  float& at(int x, int y) {
    constexpr int kMask = kPatternSide - 1;
    return values[static_cast<std::size_t>((y & kMask) * kPatternSide + (x & kMask))];
  }
  float at(int x, int y) const { return const_cast<Field*>(this)->at(x, y); }
};

// A random number in [0, 1): the `number`-th of a stream.
float random_share(std::uint32_t stream, std::uint32_t number);

// Sum of `octaves` of smooth noise, in about [−1, 1]. The first has `cells_x` × `cells_y` lattice
// points (powers of two up to kPatternSide), each next twice as many of `gain` times the strength.
Field tiled_noise(int cells_x, int cells_y, int octaves, float gain, std::uint32_t stream);

// The nearest of points scattered one in each cell of a grid.
struct Cells {
  Field edge;   // distance to the border of the cell, in widths of the grid's cells, 0 to about 1
  Field tone;   // random for each cell, 0 to 1
  Field slope;  // a plane of random tilt over each cell, about −1 to 1
};
Cells cells(int per_side, std::uint32_t stream);

// A stroke like a blade of grass or a twig: places in texels, from a foot to a tip that is
// narrower. It covers what is lower.
struct Stroke {
  float x = 0, y = 0, dx = 0, dy = 0;  // foot, and from there to the tip
  float width = 1;                     // of the foot, texels
  float low = 0, high = 1;             // height of foot and tip
  float tone = 0;
};
void draw_stroke(const Stroke& stroke, Field& height, Field& tone);

// Rise of a height per texel to the right and downwards.
std::array<Field, 2> height_gradient(const Field& height);

// The height minus the mean of the square of texels around it: below 0 in hollows, above 0 on tops.
Field raised(const Field& height, int reach);

}  // namespace psygen::render
