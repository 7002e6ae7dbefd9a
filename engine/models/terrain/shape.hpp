// The parameters of a terrain as its kernels use them. Shared by the mesh (terrain.cpp) and the
// ground queries (ground.cpp).
#pragma once

#include <algorithm>
#include <cstdint>

#include "engine/models/kit/packing.hpp"
#include "engine/models/model_type.hpp"
#include "engine/models/terrain/ridged_noise.hpp"

namespace psygen::models {

struct TerrainShape {
  RidgedNoise noise;
  int size;
  int node_level;
  double cell_m;   // between neighbouring vertices of level 0, of this node level
  float relief_m;  // height of the quantised value 65535; 0 is height 0
  float quantum;   // noise → quantised value
  float metres;    // noise → metres

  explicit TerrainShape(const Parameters& p);

  // World coordinate of vertex i of a block, which need not be one of its own, in cells of node
  // level 0.
  std::int64_t world_of(std::int64_t block, std::int64_t i) const {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(block * (size - 1) + i)
                                     << node_level);
  }
  std::uint16_t quantise(float noise_value) const {
    return static_cast<std::uint16_t>(round_to_int(std::min(noise_value * quantum, 65535.0F)));
  }
};

}  // namespace psygen::models
