// Masks: where instances of a scatter may stand, beside limits of height and slope. A picture and
// patches of noise leave some instances out; kinds of ground are limits. Pure functions of the
// place, the same on every machine; any thread. They read no files (files/scatter_file.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <string>
#include <vector>

namespace psygen::world {

// Grey values, row by row from the top, 0 … 65535.
struct GreyPicture {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint16_t> pixels;
  std::uint64_t hash = 0;  // of everything above

  // Linear between the middles of pixels, 0 … 1; (0, 0) is the upper left corner, (1, 1) the lower
  // right one. Outside, the value of the border.
  double at(double u, double v) const;
};

// What GreyPicture::hash must be: the sum, modulo 2^64, of the shares of its rows and its width. So
// the hash of a picture of which rows have changed follows from theirs.
std::uint64_t content_hash(const GreyPicture& picture);
// The share of one row.
std::uint64_t row_hash(const GreyPicture& picture, std::uint32_t row);

struct ScatterMask {
  std::string image;  // relative to the folder of the world's file; empty: none
  std::shared_ptr<const GreyPicture> picture;
  // The rectangle of the picture in metres of the world: x and z of its upper left corner, of its
  // lower right one. All 0: the whole world. Beyond it nothing stands.
  std::array<double, 4> area_m{};
  double noise_m = 0;        // size of patches; 0: none
  double share = 0.5;        // of the ground that patches cover
  std::int64_t patches = 0;  // which ones: equal numbers, sizes and shares are equal patches
  std::uint32_t ground = 0;  // allowed kinds, 1 << GroundKind; 0: all

  bool thins() const { return picture != nullptr || noise_m > 0; }
  // Equal pictures are equal in content.
  friend bool operator==(const ScatterMask& a, const ScatterMask& b);
};

// The share of instances that stand at a place of the world, 0 … 1.
double mask_share(const ScatterMask& mask, std::uint64_t seed, glm::dvec2 place_m);

// Of everything that decides what stands where; 0 for a mask that allows everything.
std::uint64_t mask_hash(const ScatterMask& mask);

}  // namespace psygen::world
