// The seam between the settings of ridged noise (ridged_noise.cpp) and its SIMD kernel
// (ridged_kernel.cpp), which is compiled once for every instruction set. Not for other files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace psygen::models {

inline constexpr int kMaxOctaves = 16;
// Longest axis of one call; a multiple of the lanes of every instruction set.
inline constexpr std::size_t kMaxNoiseAxis = 144;
// Octaves that a warp moves: those whose ridges the eye follows.
inline constexpr int kWarpedOctaves = 3;

struct RidgedOctave {
  std::uint64_t step;                // Q32.32 lattice cells per integer
  std::uint64_t origin_x, origin_z;  // Q32.32 lattice position of integer 0
  std::uint32_t key_x, key_z;
  float limit;  // largest weight: lacunarity^(−H·o)
};

// Everything is scaled by κ = √(gain · lacunarity^−H), so that one product serves as the octave's
// share of the sum and as the weight of the next octave (docs/models.md, "Height").
struct RidgedKernel {
  std::array<RidgedOctave, kMaxOctaves> octaves{};  // also those beyond octave_count are read
  int octave_count;
  float offset;                            // κ · offset
  float amplitude;                         // κ: length of gradients; values lie in ± half of it
  float result_scale;                      // κ^−2
  float warp;                              // largest displacement, in cells of octave 0; 0: none
  std::array<RidgedOctave, 2> warp_field;  // its parts along x and z; limits are not used
  std::array<float, kWarpedOctaves> cells_ratio;  // cells of an octave in one of octave 0
};

// values[r · stride + c] for all columns and rows, on the best instruction set of this CPU. At most
// kMaxNoiseAxis columns and rows, at least one of each.
void evaluate_ridged(const RidgedKernel& kernel, std::span<const std::int64_t> columns,
                     std::span<const std::int64_t> rows, float* values, std::size_t stride);

}  // namespace psygen::models
