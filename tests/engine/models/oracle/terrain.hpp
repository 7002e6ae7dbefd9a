// An independent ridged multifractal, as docs/models.md defines it: one point at a time, in double
// precision, with the library's power. Slow and plain; the tests compare the engine with it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/core/hash.hpp"

namespace psygen::models::test {

struct TerrainOracle {
  std::uint64_t seed = 0;
  double height = 1, lacunarity = 2, offset = 1, gain = 2, cells_per_step = 1;
  int octaves = 9;
  double warp = 0;

  static std::uint32_t mix(std::uint32_t h) {
    h ^= h >> 16;
    h *= 0x7FEB352DU;
    h ^= h >> 15;
    h *= 0x846CA68BU;
    h ^= h >> 16;
    return h;
  }

  static constexpr std::uint64_t kWarp = std::uint64_t{1} << 32;
  static constexpr double kMaxNoise = 1.2075;

  std::uint64_t key(std::uint64_t octave) const { return core::combine(seed, octave); }
  std::uint64_t step(std::uint64_t octave) const {
    double frequency = octave >= kWarp ? cells_per_step / 2 : cells_per_step;
    for (std::uint64_t o = 0; octave < kWarp && o < octave; ++o)
      frequency *= lacunarity;
    return static_cast<std::uint64_t>(std::fmod(frequency, 4294967296.0) * 4294967296.0 + 0.5);
  }
  // Q32.32 position of a world coordinate on the lattice of an octave.
  std::uint64_t lattice_x(std::uint64_t octave, std::int64_t x) const {
    return static_cast<std::uint64_t>(x) * step(octave) + core::mix64(key(octave));
  }
  std::uint64_t lattice_z(std::uint64_t octave, std::int64_t z) const {
    return static_cast<std::uint64_t>(z) * step(octave) + core::mix64(key(octave) + 1);
  }

  // Sine of t quarter turns: close to the library's.
  static double sine(double t) { return t * (1.57032 + t * t * (-0.64211 + t * t * 0.07186)); }
  static double cosine(double t) { return 0.9994 + t * t * (-1.2228 + t * t * 0.224); }

  // Contribution of a lattice point to a sample dx and dz cells away: its value and the scalar
  // product of its gradient with the offset.
  double corner(std::uint64_t octave, std::uint32_t ix, std::uint32_t iz, double dx,
                double dz) const {
    const std::uint64_t keys = core::mix64(key(octave) + 2);
    const std::uint32_t row = mix(iz + static_cast<std::uint32_t>(keys));
    const std::uint32_t h = mix((ix + static_cast<std::uint32_t>(keys >> 32)) ^ row);
    const double t = static_cast<std::int32_t>(h) / 2147483648.0;
    const double value = (h % 256 < 128 ? h % 256 : h % 256 - 256.0) / 256;
    return value + (h % 2 == 1 ? -cosine(t) : cosine(t)) * dx + sine(t) * dz;
  }

  // Noise of an octave, or of the warp's field along x or z (octaves kWarp and kWarp + 1), dx and
  // dz of its cells away from a world coordinate.
  double noise(std::uint64_t octave, std::int64_t x, std::int64_t z, double dx = 0,
               double dz = 0) const {
    const std::uint64_t qx = lattice_x(octave, x), qz = lattice_z(octave, z);
    const double px = static_cast<double>(qx & 0xFFFFFFFFU) / 4294967296.0 + dx;
    const double pz = static_cast<double>(qz & 0xFFFFFFFFU) / 4294967296.0 + dz;
    const auto cell = [](std::uint64_t q, double p) {
      return static_cast<std::uint32_t>(static_cast<std::int64_t>(q >> 32) +
                                        static_cast<std::int64_t>(std::floor(p)));
    };
    const std::uint32_t ix = cell(qx, px), iz = cell(qz, pz);
    const double fx = px - std::floor(px), fz = pz - std::floor(pz);
    const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const auto mixed = [](double a, double b, double t) { return a + t * (b - a); };
    return mixed(
        mixed(corner(octave, ix, iz, fx, fz), corner(octave, ix + 1, iz, fx - 1, fz), fade(fx)),
        mixed(corner(octave, ix, iz + 1, fx, fz - 1),
              corner(octave, ix + 1, iz + 1, fx - 1, fz - 1), fade(fx)),
        fade(fz));
  }
  double warped_noise(int octave, std::int64_t x, std::int64_t z) const {
    const auto o = static_cast<std::uint64_t>(octave);
    if (warp == 0 || octave >= 3) return noise(o, x, z);
    const double cells = warp * 0.828427125 * std::pow(lacunarity, octave);
    return noise(o, x, z, cells * noise(kWarp, x, z), cells * noise(kWarp + 1, x, z));
  }

  double value(std::int64_t x, std::int64_t z) const {
    double sum = 0, weight = 1;
    for (int o = 0; o < octaves; ++o) {
      const double ridge = offset - std::abs(warped_noise(o, x, z));
      const double signal = weight * ridge * ridge;
      sum += signal * std::pow(lacunarity, -height * o);
      weight = std::clamp(gain * signal, 0.0, 1.0);
    }
    return sum;
  }

  double max_value() const {
    double sum = 0;
    for (int o = 0; o < octaves; ++o)
      sum += std::max(offset * offset, (offset - kMaxNoise) * (offset - kMaxNoise)) *
             std::pow(lacunarity, -height * o);
    return sum;
  }
};

}  // namespace psygen::models::test
