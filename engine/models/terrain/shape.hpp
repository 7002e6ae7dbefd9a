// The parameters of a terrain in the form that its kernels use. Shared by the mesh (terrain.cpp)
// and the ground queries (ground.cpp). Immutable, any thread. Internal to the terrain.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "engine/models/ground/stack.hpp"
#include "engine/models/kit/packing.hpp"
#include "engine/models/model_type.hpp"
#include "engine/models/terrain/ridged_noise.hpp"

namespace psygen::models {

// The noise, the layers over it and the scales of one node of terrain.
struct TerrainShape {
  RidgedNoise noise;
  int size;        // vertices per side at level 0
  int node_level;  // 0: a block; each further level doubles the cells
  double cell_m;   // between neighbouring vertices of level 0, at this node level
  float relief_m;  // height of the quantised value 65535; the value 0 has height 0
  float quantum;   // quantised height of noise 1
  float metres;    // height of noise 1, in metres
  std::uint64_t seed;
  const GroundStack* stack = nullptr;  // of the parameters; null: only noise. Not owned

  // Requires legal parameters.
  explicit TerrainShape(const Parameters& p);

  // World coordinate of vertex i of a block, in cells of node level 0. Vertices outside the block
  // are allowed.
  std::int64_t world_of(std::int64_t block, std::int64_t i) const {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(block * (size - 1) + i)
                                     << node_level);
  }
  // Every height of the engine: the noise and all layers over it, at the lattice points
  // (columns[i], rows[k]), values[k · stride + i], in units of the noise. Both ascend, in cells of
  // node level 0, at most RidgedNoise::kMaxAxis. The same bits for the same point and detail.
  void evaluate(std::span<const std::int64_t> columns, std::span<const std::int64_t> rows,
                std::span<float> values, std::size_t stride, GroundDetail detail) const;
  // The detail of the node's meshes, and that of grid `grid` of its light.
  GroundDetail detail() const { return GroundDetail::of_node(node_level); }
  GroundDetail light_detail(int grid) const { return GroundDetail::of_light(node_level, grid); }
  // The octaves that the noise has at a detail.
  int octaves(GroundDetail detail) const;
  // Time that the layers take in evaluate() of this many heights, spread evenly over a rectangle in
  // cells of node level 0, in units of RidgedNoise::work(). 0 without layers.
  double layer_work(LatticeSpan x, LatticeSpan z, double heights, GroundDetail detail) const;
  // Calls visit(tile) for the patches of the network that evaluate() may read for heights in a
  // rectangle, in cells of node level 0; some more than once.
  void each_patch(LatticeSpan x, LatticeSpan z, GroundDetail detail,
                  const std::function<void(const network::TileKey&)>& visit) const;
  // The erosion at a detail, if there is any.
  std::optional<ErosionFilter> filter(GroundDetail detail) const;
  // The quantised height of a value of the noise, 0 … 65535. The same bits as in the kernel.
  std::uint16_t quantise(float noise_value) const {
    return static_cast<std::uint16_t>(round_to_int(std::min(noise_value * quantum, 65535.0F)));
  }

 private:
  GroundScale scale() const;
  void evaluate_network(std::span<const std::int64_t> columns, std::span<const std::int64_t> rows,
                        std::span<float> values, std::size_t stride, GroundDetail detail) const;
};

}  // namespace psygen::models
