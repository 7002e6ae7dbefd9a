// Masks of the ground: how strongly a shape acts at each place. A mask is the product of a picture,
// patches of noise, and ranges of height and slope with soft ends. It reads the place and the guide
// (erosion.hpp), the slow ground below all shapes, and never the running height, so the order of
// shapes changes no mask. Pure functions without libm, the same bits on every machine. Plain
// values, immutable in use, any thread. Pictures also serve masks of scatters (world/mask.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "engine/models/ground/water.hpp"

namespace psygen::models {

// A greyscale image: values 0 … 65535, row by row from the top.
struct GreyPicture {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint16_t> pixels;
  std::uint64_t hash = 0;  // content_hash() of all members above

  // Linear interpolation between pixel centres, 0 … 1. (0, 0) is the upper left corner, (1, 1) the
  // lower right one. Outside, the value of the border.
  double at(double u, double v) const;
  // The same at a place for a picture that covers a rectangle: its least x and z, then its largest.
  // 0 outside of it.
  double over(const std::array<double, 4>& area_m, glm::dvec2 place_m) const;
};

// The required value of GreyPicture::hash: the sum modulo 2^64 of the row hashes and the width.
// After some rows have changed, their row hashes are enough to update it.
std::uint64_t content_hash(const GreyPicture& picture);
// The contribution of one row.
std::uint64_t row_hash(const GreyPicture& picture, std::uint32_t row);

// Noise of patches with frayed borders, 0 … 1. Patches below 0.1 m are enlarged to this size, so
// that lattice points of the largest world fit in 64 bits.
double patch_noise(std::uint64_t seed, glm::dvec2 place_m, double patch_m);
// The value that this noise stays below on a fraction of the ground; 2 for a fraction of 1.
double patch_noise_below(double share);

// A range of numbers with soft ends: 0 at an end, 1 from its fade inside on.
struct FadedRange {
  double min = -std::numeric_limits<double>::infinity(), min_fade = 0;
  double max = std::numeric_limits<double>::infinity(), max_fade = 0;

  bool is_limited() const {
    return min > -std::numeric_limits<double>::infinity() ||
           max < std::numeric_limits<double>::infinity();
  }
  // The weight of a number, 0 … 1.
  double share(double number) const {
    return faded(number - min, min_fade) * faded(max - number, max_fade);
  }
};

struct GroundMask {
  std::shared_ptr<const GreyPicture> picture;  // null: none
  // The rectangle of the picture, in metres of the world: x and z of its upper left and lower right
  // corner; 0 outside of it. All 0: the rectangle of the shape, turned with it.
  std::array<double, 4> area_m{};
  double noise_m = 0;         // size of patches; 0: no patches
  double share = 0.5;         // fraction of the ground that patches cover
  std::uint64_t patches = 0;  // seed of the patches
  FadedRange height_m;        // of the guide
  FadedRange slope;           // of the guide: rise over run

  // Number of heights of the guide that it reads for a place; slopes read four around it.
  static constexpr int kMaxGuideReads = 5;
  int guide_reads() const {
    return slope.is_limited() ? kMaxGuideReads : height_m.is_limited() ? 1 : 0;
  }
  bool reads_guide() const { return guide_reads() > 0; }
  // Features of the guide narrower than this many cells are left out.
  static constexpr double kGuideCells = 8;
  // The picture and the patches at a place in metres of the world, 0 … 1. `own` is the place in the
  // rectangle of the shape: (0, 0) is the first corner of its image, (1, 1) the last one.
  double at(glm::dvec2 place_m, glm::dvec2 own) const;
  // The ranges at a height and a slope of the guide, 0 … 1.
  double on(double guide_m, double guide_slope) const {
    return height_m.share(guide_m) * slope.share(guide_slope);
  }
  // Hash of everything above. Constant time.
  std::uint64_t hash() const;
  // The largest change of the mask over a metre, for a shape whose shorter side has this length;
  // 1e30: unknown.
  double steepness(double side_m) const;
};

}  // namespace psygen::models
