// The seam between the settings of ridged noise (ridged_noise.cpp) and its SIMD kernel
// (ridged_kernel.cpp), which is compiled once per instruction set. Internal to the noise. Pure, any
// thread. docs/models.md, "Height".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace psygen::models {

inline constexpr int kMaxOctaves = 16;
// Longest axis of one call; a multiple of the lanes of every instruction set.
inline constexpr std::size_t kMaxNoiseAxis = 144;
// Number of octaves that a warp moves, from the coarsest. Only their ridges are noticeable lines.
inline constexpr int kWarpedOctaves = 3;

// One octave of noise: a lattice and its random numbers.
struct RidgedOctave {
  std::uint64_t step;                // Q32.32 lattice cells per integer
  std::uint64_t origin_x, origin_z;  // Q32.32 lattice position of integer 0
  std::uint32_t key_x, key_z;        // added to cells before hashing
  float limit;                       // largest weight: lacunarity^(−H·o)
};

// The constants of a noise, scaled by κ = √(gain · lacunarity^−H). Then one product is both the
// octave's term of the sum and the weight of the next octave (docs/models.md, "Height").
struct RidgedKernel {
  std::array<RidgedOctave, kMaxOctaves> octaves{};  // those beyond octave_count are read too
  int octave_count;                                 // 1 … kMaxOctaves
  float offset;                                     // κ · offset
  float amplitude;                         // κ: length of gradients; values lie within ± κ / 2
  float result_scale;                      // κ^−2
  float warp;                              // largest displacement, in cells of octave 0; 0: none
  std::array<RidgedOctave, 2> warp_field;  // displacement along x and z; limits are not used
  std::array<float, kWarpedOctaves> cells_ratio;  // cells of an octave per cell of octave 0
};

// Writes values[r · stride + c] for all columns and rows, on the best instruction set of this CPU.
// 1 … kMaxNoiseAxis columns and rows, stride >= columns.size().
void evaluate_ridged(const RidgedKernel& kernel, std::span<const std::int64_t> columns,
                     std::span<const std::int64_t> rows, float* values, std::size_t stride);

}  // namespace psygen::models
