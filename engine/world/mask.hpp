// Masks restrict the instances of a scatter beyond limits of height and slope. An image and patches
// of noise thin instances out; kinds of ground are limits. Pure functions of the position, the same
// on every machine; any thread. They read no files (files/scatter_file.hpp). Stamps have the image
// and the patches too, but with soft borders (models/ground/ground_mask.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/models/ground/ground_mask.hpp"

namespace psygen::world {

using models::content_hash;
using models::GreyPicture;
using models::row_hash;

// The numbers of an image as its file stores them, row by row from the top.
struct HeightPicture {
  std::uint32_t width = 0, height = 0;
  std::vector<float> values;          // NaN: the pixel has no height
  std::vector<std::uint16_t> wholes;  // instead of `values`, if all are whole, 0 … 65535
  double white = 1;                   // the number of white; black is 0
  bool is_coloured = false;           // the colours of some pixel differ
  std::uint64_t hash = 0;             // of all members above

  std::size_t pixels() const { return values.size() + wholes.size(); }
  float number(std::size_t pixel) const {
    return wholes.empty() ? values[pixel] : static_cast<float>(wholes[pixel]);
  }
};
// The picture with its hash, in as little memory as its numbers need.
HeightPicture finished(HeightPicture picture);
// The numbers of a greyscale image.
HeightPicture heights_of(const GreyPicture& picture);

struct ScatterMask {
  std::string image;  // relative to the folder of the world's file; empty: none
  std::shared_ptr<const GreyPicture> picture;
  // The rectangle that the image covers, in metres of the world: x and z of its upper left and
  // lower right corner. All 0: the whole world. Nothing stands outside the rectangle.
  std::array<double, 4> area_m{};
  double noise_m = 0;        // size of the patches; 0: no patches
  double share = 0.5;        // fraction of the ground that the patches cover
  double fade = 0;           // of the borders of patches: 0 sharp … 1 fading over all of them
  std::int64_t patches = 0;  // seed: equal seed, size and share give equal patches
  std::uint32_t ground = 0;  // allowed kinds, bits 1 << GroundKind; 0: all

  bool thins() const { return picture != nullptr || noise_m > 0; }
  // Compares images by content.
  friend bool operator==(const ScatterMask& a, const ScatterMask& b);
};

// The seed of its patches in a world of this seed.
std::uint64_t patch_seed(const ScatterMask& mask, std::uint64_t world_seed);

// The fraction of instances that the mask keeps at a position of the world, 0 … 1.
double mask_share(const ScatterMask& mask, std::uint64_t seed, glm::dvec2 place_m);

// A hash of everything that decides which instances stand; 0 for a mask that allows all.
std::uint64_t mask_hash(const ScatterMask& mask);

}  // namespace psygen::world
