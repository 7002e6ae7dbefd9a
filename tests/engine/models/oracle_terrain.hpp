// The ridged multifractal once more, as docs/models.md defines it: one point at a time, in double
// precision, with the library's sine and power. Slow and plain; the tests hold the engine to it.
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

  static std::uint32_t mix(std::uint32_t h) {
    h ^= h >> 16;
    h *= 0x7FEB352DU;
    h ^= h >> 15;
    h *= 0x846CA68BU;
    h ^= h >> 16;
    return h;
  }

  std::uint64_t key(int octave) const {
    return core::combine(seed, static_cast<std::uint64_t>(octave));
  }
  std::uint64_t step(int octave) const {
    double frequency = cells_per_step;
    for (int o = 0; o < octave; ++o)
      frequency *= lacunarity;
    return static_cast<std::uint64_t>(std::fmod(frequency, 4294967296.0) * 4294967296.0 + 0.5);
  }
  // Q32.32 position of a world coordinate on the lattice of an octave.
  std::uint64_t lattice_x(int octave, std::int64_t x) const {
    return static_cast<std::uint64_t>(x) * step(octave) + core::mix64(key(octave));
  }
  std::uint64_t lattice_z(int octave, std::int64_t z) const {
    return static_cast<std::uint64_t>(z) * step(octave) + core::mix64(key(octave) + 1);
  }

  // Scalar product of the gradient at a lattice point with the way to the sample.
  double corner(int octave, std::uint32_t ix, std::uint32_t iz, double dx, double dz) const {
    const std::uint64_t keys = core::mix64(key(octave) + 2);
    const std::uint32_t row = mix(iz + static_cast<std::uint32_t>(keys));
    const std::uint32_t h = mix((ix + static_cast<std::uint32_t>(keys >> 32)) ^ row);
    double angle = std::acos(-1.0) / 2 * ((h >> 8) / 8388608.0 - 1);
    if (h % 2 == 1) angle += std::acos(-1.0);
    return std::sqrt(2.0) * (std::cos(angle) * dx + std::sin(angle) * dz);
  }

  double noise(int octave, std::int64_t x, std::int64_t z) const {
    const std::uint64_t qx = lattice_x(octave, x), qz = lattice_z(octave, z);
    const auto ix = static_cast<std::uint32_t>(qx >> 32);
    const auto iz = static_cast<std::uint32_t>(qz >> 32);
    const double fx = static_cast<double>(qx & 0xFFFFFFFFU) / 4294967296.0;
    const double fz = static_cast<double>(qz & 0xFFFFFFFFU) / 4294967296.0;
    const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const auto mixed = [](double a, double b, double t) { return a + t * (b - a); };
    return mixed(
        mixed(corner(octave, ix, iz, fx, fz), corner(octave, ix + 1, iz, fx - 1, fz), fade(fx)),
        mixed(corner(octave, ix, iz + 1, fx, fz - 1),
              corner(octave, ix + 1, iz + 1, fx - 1, fz - 1), fade(fx)),
        fade(fz));
  }

  double value(std::int64_t x, std::int64_t z) const {
    double sum = 0, weight = 1;
    for (int o = 0; o < octaves; ++o) {
      const double ridge = offset - std::abs(noise(o, x, z));
      const double signal = weight * ridge * ridge;
      sum += signal * std::pow(lacunarity, -height * o);
      weight = std::clamp(gain * signal, 0.0, 1.0);
    }
    return sum;
  }

  double max_value() const {
    double sum = 0;
    for (int o = 0; o < octaves; ++o)
      sum += std::max(offset * offset, (offset - 1) * (offset - 1)) *
             std::pow(lacunarity, -height * o);
    return sum;
  }
};

}  // namespace psygen::models::test
