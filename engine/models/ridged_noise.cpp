#include "engine/models/ridged_noise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/assert.hpp"
#include "engine/core/hash.hpp"
#include "engine/models/exact_math.hpp"

namespace psygen::models {
namespace {

constexpr std::size_t kMaxAxis = RidgedNoise::kMaxAxis;
constexpr double kTwo32 = 4294967296.0;

// Bijective mixing of 32 bits in two rounds (constants: Wellons 2018, "Prospecting for hash
// functions", public domain).
constexpr std::uint32_t mix32(std::uint32_t h) {
  h = (h ^ (h >> 16)) * 0x7FEB352DU;
  h = (h ^ (h >> 15)) * 0x846CA68BU;
  return h ^ (h >> 16);
}

// The position of an integer on one axis of an octave's lattice.
struct LatticePosition {
  std::uint32_t cell;
  float fraction;  // [0, 1), 24 bits
  float fade;
};
LatticePosition lattice_position(std::int64_t coordinate, std::uint64_t step,
                                 std::uint64_t origin) {
  const std::uint64_t q = static_cast<std::uint64_t>(coordinate) * step + origin;
  const auto bits = static_cast<std::int32_t>((q >> 8) & 0xFFFFFFU);
  const float f = static_cast<float>(bits) * 0x1.0p-24F;
  return {static_cast<std::uint32_t>(q >> 32), f, f * f * f * (f * (f * 6.0F - 15.0F) + 10.0F)};
}

}  // namespace

// One octave's view of the columns: which lattice columns are needed, and where each sample lies
// between two of them. Lattice columns `first[i]` and `first[i] + 1` surround sample i.
struct RidgedNoise::Column {
  std::array<std::uint16_t, kMaxAxis> first;
  std::array<float, kMaxAxis> fraction;
  std::array<float, kMaxAxis> fade;
  std::array<std::uint32_t, 2 * kMaxAxis> lattice;
  std::size_t lattice_count = 0;

  Column(std::span<const std::int64_t> columns, const Octave& octave) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const LatticePosition p = lattice_position(columns[i], octave.step, octave.origin_x);
      if (lattice_count == 0 || lattice[lattice_count - 2] != p.cell) {
        if (lattice_count == 0 || lattice[lattice_count - 1] != p.cell)
          lattice[lattice_count++] = p.cell;
        lattice[lattice_count++] = p.cell + 1;
      }
      first[i] = static_cast<std::uint16_t>(lattice_count - 2);
      fraction[i] = p.fraction;
      fade[i] = p.fade;
    }
  }
};

// Gradients of length √2 along one lattice row: direction π/2 · t from the x axis, t uniform in
// [−1, 1), turned round by a further bit. Sine and cosine by their Taylor polynomials.
struct RidgedNoise::GradientRow {
  std::array<float, 2 * kMaxAxis> x, z;

  void fill(const Column& column, std::uint32_t row, const Octave& octave) {
    const std::uint32_t row_hash = mix32(row + octave.key_z);
    for (std::size_t i = 0; i < column.lattice_count; ++i) {
      const std::uint32_t h = mix32((column.lattice[i] + octave.key_x) ^ row_hash);
      const float t = static_cast<float>(static_cast<std::int32_t>(h >> 8)) * 0x1.0p-23F - 1.0F;
      const float angle = t * 1.57079633F;
      const float length = (h & 1U) != 0 ? -1.41421356F : 1.41421356F;
      const float y = angle * angle;
      const float sine =
          angle *
          (1.0F +
           y * (-1.0F / 6 + y * (1.0F / 120 + y * (-1.0F / 5040 +
                                                   y * (1.0F / 362880 + y * (-1.0F / 39916800))))));
      const float cosine =
          1.0F +
          y * (-0.5F + y * (1.0F / 24 +
                            y * (-1.0F / 720 + y * (1.0F / 40320 + y * (-1.0F / 3628800 +
                                                                        y * (1.0F / 479001600))))));
      x[i] = cosine * length;
      z[i] = sine * length;
    }
  }
};

namespace {

// The noise of one row is linear in x between lattice columns: slope · x + base, where x counts
// from the lattice column.
struct BlendedRow {
  std::array<float, 2 * kMaxAxis> slope, base;

  template <class Gradients>
  void fill(const Gradients& below, const Gradients& above, std::size_t count, float fraction,
            float fade) {
    const float fraction_above = fraction - 1.0F;
    for (std::size_t i = 0; i < count; ++i) {
      slope[i] = below.x[i] + fade * (above.x[i] - below.x[i]);
      const float low = below.z[i] * fraction;
      const float high = above.z[i] * fraction_above;
      base[i] = low + fade * (high - low);
    }
  }
};

// Adds one octave to one row of values and leaves the weights of the next octave.
struct RidgeRow {
  float offset, gain, amplitude;
  void add(const float* __restrict noise, float* __restrict values, float* __restrict weights,
           std::size_t count) const {
    for (std::size_t i = 0; i < count; ++i) {
      const float ridge = offset - std::abs(noise[i]);
      const float signal = weights[i] * (ridge * ridge);
      values[i] += signal * amplitude;
      const float next = gain * signal;  // never negative
      weights[i] = next < 1.0F ? next : 1.0F;
    }
  }
};

template <class Columns>
void row_noise(const Columns& column, const BlendedRow& row, std::size_t count,
               float* __restrict noise) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = column.first[i];
    const float left = row.slope[k] * column.fraction[i] + row.base[k];
    const float right = row.slope[k + 1] * (column.fraction[i] - 1.0F) + row.base[k + 1];
    noise[i] = left + column.fade[i] * (right - left);
  }
}

}  // namespace

RidgedNoise::RidgedNoise(const RidgedSettings& s)
    : octave_count_(s.octaves),
      offset_(static_cast<float>(s.offset)),
      gain_(static_cast<float>(s.gain)) {
  PSYGEN_ASSERT(s.octaves >= 1 && s.octaves <= kMaxOctaves, "octaves are within their range");
  const double highest = std::max(s.offset * s.offset, (s.offset - 1) * (s.offset - 1));
  const double ratio = exact_pow(s.lacunarity, -s.height);
  double frequency = s.cells_per_step;
  double amplitude = 1;
  for (int o = 0; o < octave_count_; ++o) {
    const std::uint64_t key = core::combine(s.seed, static_cast<std::uint64_t>(o));
    const std::uint64_t noise_key = core::mix64(key + 2);
    octaves_[static_cast<std::size_t>(o)] = {
        .step = static_cast<std::uint64_t>(std::fmod(frequency, kTwo32) * kTwo32 + 0.5),
        .origin_x = core::mix64(key),
        .origin_z = core::mix64(key + 1),
        .key_x = static_cast<std::uint32_t>(noise_key >> 32),
        .key_z = static_cast<std::uint32_t>(noise_key),
        .amplitude = static_cast<float>(amplitude)};
    max_value_ += highest * amplitude;
    frequency *= s.lacunarity;
    amplitude *= ratio;
  }
}

void RidgedNoise::evaluate(std::span<const std::int64_t> columns,
                           std::span<const std::int64_t> rows, std::span<float> values,
                           std::size_t stride) const {
  PSYGEN_ASSERT(columns.size() <= kMaxAxis && rows.size() <= kMaxAxis, "axes are short enough");
  PSYGEN_ASSERT(stride >= columns.size() && values.size() >= rows.size() * stride,
                "the values have room for every row");
  std::array<float, kMaxAxis * kMaxAxis> weight_storage;
  const std::span<float> weights(weight_storage);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(r * stride), columns.size(), 0.0F);
    std::fill_n(weights.begin() + static_cast<std::ptrdiff_t>(r * columns.size()), columns.size(),
                1.0F);
  }
  for (int o = 0; o < octave_count_; ++o)
    add_octave(octaves_[static_cast<std::size_t>(o)], columns, rows, values, weights, stride);
}

void RidgedNoise::add_octave(const Octave& octave, std::span<const std::int64_t> columns,
                             std::span<const std::int64_t> rows, std::span<float> values,
                             std::span<float> weights, std::size_t stride) const {
  const std::size_t count = columns.size();
  const Column column(columns, octave);
  const RidgeRow ridge{offset_, gain_, octave.amplitude};
  GradientRow storage[2];
  GradientRow *below = &storage[0], *above = &storage[1];
  BlendedRow blended;
  std::array<float, kMaxAxis> noise;
  std::uint32_t current = 0;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const LatticePosition z = lattice_position(rows[r], octave.step, octave.origin_z);
    if (r == 0 || z.cell != current) {
      if (r != 0 && z.cell == current + 1) {
        std::swap(below, above);
      } else {
        below->fill(column, z.cell, octave);
      }
      above->fill(column, z.cell + 1, octave);
      current = z.cell;
    }
    blended.fill(*below, *above, column.lattice_count, z.fraction, z.fade);
    row_noise(column, blended, count, noise.data());
    ridge.add(noise.data(), values.data() + r * stride, weights.data() + r * count, count);
  }
}

}  // namespace psygen::models
