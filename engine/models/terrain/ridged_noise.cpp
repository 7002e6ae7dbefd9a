#include "engine/models/terrain/ridged_noise.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/assert.hpp"
#include "engine/core/hash.hpp"
#include "engine/models/kit/exact_math.hpp"

namespace psygen::models {
namespace {

// Reached where all four gradients of a lattice cell point at its centre: ½ + 1.0005/√2.
constexpr double kMaxNoise = 1.2075;
constexpr double kTwo32 = 4294967296.0;

// Lattice cells per integer modulo 2^32 as Q32.32, rounded to nearest. Exact up to this rounding,
// because `frequency` is positive and the divisor is a power of two.
std::uint64_t fixed_point(double frequency) {
  const double rest = frequency - std::floor(frequency / kTwo32) * kTwo32;
  return static_cast<std::uint64_t>(rest * kTwo32 + 0.5);
}

constexpr std::uint64_t kWarpKey = std::uint64_t{1} << 32;

RidgedOctave octave_of(std::uint64_t key, double frequency) {
  const std::uint64_t noise_key = core::mix64(key + 2);
  return {.step = fixed_point(frequency),
          .origin_x = core::mix64(key),
          .origin_z = core::mix64(key + 1),
          .key_x = static_cast<std::uint32_t>(noise_key >> 32),
          .key_z = static_cast<std::uint32_t>(noise_key),
          .limit = 0};
}

}  // namespace

RidgedNoise::RidgedNoise(const RidgedSettings& s)
    : cells_per_step_(s.cells_per_step), lacunarity_(s.lacunarity) {
  PSYGEN_ASSERT(s.octaves >= 1 && s.octaves <= kMaxOctaves, "octaves are within their range");
  const double deepest = s.offset - kMaxNoise;
  const double highest = std::max(s.offset * s.offset, deepest * deepest);
  max_ridge_ = highest;
  const double ratio = exact_pow(s.lacunarity, -s.height);
  // With a gain so small that further octaves vanish in single precision, only the first is kept.
  const double square = s.gain * ratio;
  const bool one_octave = square < 1e-8;
  const double scale = one_octave ? 1 : std::sqrt(square);
  kernel_.octave_count = one_octave ? 1 : s.octaves;
  kernel_.offset = static_cast<float>(scale * s.offset);
  kernel_.amplitude = static_cast<float>(scale);
  kernel_.result_scale = static_cast<float>(one_octave ? 1 : 1 / square);
  kernel_.warp = static_cast<float>(s.warp);
  for (std::size_t i = 0; i < 2; ++i)
    kernel_.warp_field[i] = octave_of(core::combine(s.seed, kWarpKey + i), 0.5 * s.cells_per_step);
  double cells = 1;
  for (float& octave_cells : kernel_.cells_ratio) {
    octave_cells = static_cast<float>(cells);
    cells *= s.lacunarity;
  }
  double frequency = s.cells_per_step;
  double amplitude = 1;
  for (int o = 0; o < s.octaves; ++o) {
    RidgedOctave& octave = kernel_.octaves[static_cast<std::size_t>(o)];
    octave = octave_of(core::combine(s.seed, static_cast<std::uint64_t>(o)), frequency);
    octave.limit = static_cast<float>(amplitude);
    max_value_ += highest * amplitude;
    frequency *= s.lacunarity;
    amplitude *= ratio;
  }
}

double RidgedNoise::max_value(int octaves) const {
  if (octaves >= kernel_.octave_count) return max_value_;
  double sum = 0;
  for (std::size_t o = 0; o < static_cast<std::size_t>(octaves); ++o)
    sum += max_ridge_ * static_cast<double>(kernel_.octaves[o].limit);
  return sum;
}

int RidgedNoise::octaves_wider_than(double steps) const {
  double cells = cells_per_step_ * lacunarity_ * steps;
  int octaves = 1;
  for (; octaves < kernel_.octave_count && cells <= 1; ++octaves)
    cells *= lacunarity_;
  return octaves;
}

// Measured (AVX-512, Zen 5): 0.14 ns per sample and octave, 0.55 ns where a lattice row is blended
// for it, 2.6 ns where a warp moves it.
double RidgedNoise::work(std::size_t columns, std::size_t rows, double spacing, int octaves) const {
  constexpr double kBlend = 4, kFree = 18, kWarpFields = 2;
  const int count = std::min(octaves, kernel_.octave_count);
  double cells = cells_per_step_ * spacing, per_sample = 0;
  for (int o = 0; o < count; ++o) {
    per_sample += 1 + kBlend * std::min(cells, 2.0);
    cells *= lacunarity_;
  }
  if (kernel_.warp > 0) per_sample += kFree * (kWarpFields + std::min(count, kWarpedOctaves));
  return static_cast<double>(columns) * static_cast<double>(rows) * per_sample;
}

void RidgedNoise::evaluate(std::span<const std::int64_t> columns,
                           std::span<const std::int64_t> rows, std::span<float> values,
                           std::size_t stride, int octaves) const {
  PSYGEN_ASSERT(columns.size() <= kMaxAxis && rows.size() <= kMaxAxis, "axes are short enough");
  PSYGEN_ASSERT(stride >= columns.size() && values.size() >= rows.size() * stride,
                "the values have room for every row");
  if (columns.empty() || rows.empty()) return;
  if (octaves >= kernel_.octave_count)
    return evaluate_ridged(kernel_, columns, rows, values.data(), stride);
  RidgedKernel kernel = kernel_;
  kernel.octave_count = octaves;
  evaluate_ridged(kernel, columns, rows, values.data(), stride);
}

}  // namespace psygen::models
