#include "engine/models/terrain/ridged_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/models/kit/exact_math.hpp"
#include "tests/engine/models/oracle/terrain.hpp"

namespace psygen::models {
namespace {

using test::TerrainOracle;

RidgedSettings settings_of(const TerrainOracle& o) {
  return {o.seed, o.height, o.lacunarity, o.octaves, o.offset, o.gain, o.cells_per_step};
}

std::vector<float> evaluate(const RidgedNoise& noise, const std::vector<std::int64_t>& columns,
                            const std::vector<std::int64_t>& rows) {
  std::vector<float> values(columns.size() * rows.size());
  noise.evaluate(columns, rows, values, columns.size());
  return values;
}

std::vector<std::int64_t> range(std::int64_t first, std::int64_t step, int count) {
  std::vector<std::int64_t> result;
  for (int i = 0; i < count; ++i)
    result.push_back(first + i * step);
  return result;
}

double correlation(const std::vector<float>& a, const std::vector<float>& b) {
  double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ma += a[i];
    mb += b[i];
  }
  ma /= static_cast<double>(a.size());
  mb /= static_cast<double>(b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += (a[i] - ma) * (a[i] - ma);
    bb += (b[i] - mb) * (b[i] - mb);
    ab += (a[i] - ma) * (b[i] - mb);
  }
  return ab / std::sqrt(aa * bb);
}

TEST(RidgedNoise, EqualsTheOracleForRandomSettingsAnywhere) {
  core::RandomStream random(3, 0, 0, 0, core::Purpose::kParameters);
  for (int trial = 0; trial < 40; ++trial) {
    const TerrainOracle oracle{.seed = random.next_u64(),
                               .height = random.next_real(0.3, 2),
                               .lacunarity = random.next_real(1.2, 3.5),
                               .offset = random.next_real(0, 1.5),
                               .gain = random.next_real(0, 4),
                               .cells_per_step = random.next_real(1e-4, 0.1),
                               .octaves = static_cast<int>(random.next_integer(1, 12))};
    const RidgedNoise noise(settings_of(oracle));
    EXPECT_NEAR(noise.max_value() / oracle.max_value(), 1, 1e-12);
    const auto columns = range(random.next_integer(-(1LL << 38), 1LL << 38), trial % 7 + 1, 9);
    const auto rows = range(random.next_integer(-(1LL << 38), 1LL << 38), trial % 5 + 1, 7);
    const std::vector<float> values = evaluate(noise, columns, rows);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t c = 0; c < columns.size(); ++c)
        EXPECT_NEAR(values[r * columns.size() + c], oracle.value(columns[c], rows[r]),
                    1e-5 * oracle.max_value());
    }
  }
}

TEST(RidgedNoise, HasTheSameBitsInAnyGroupingOfSamples) {
  const RidgedNoise noise({.seed = 11, .cells_per_step = 0.013});
  const auto columns = range(-70, 1, 140), rows = range(1'000'000, 1, 20);
  const std::vector<float> all = evaluate(noise, columns, rows);
  for (const std::int64_t step : {2, 3, 9, 63}) {
    for (std::size_t r = 0; r < rows.size(); r += static_cast<std::size_t>(step)) {
      std::vector<std::int64_t> some;
      for (std::size_t c = 0; c < columns.size(); c += static_cast<std::size_t>(step))
        some.push_back(columns[c]);
      const std::vector<float> values = evaluate(noise, some, {rows[r]});
      for (std::size_t c = 0; c < some.size(); ++c)
        ASSERT_EQ(values[c], all[r * columns.size() + c * static_cast<std::size_t>(step)]);
    }
  }
  const std::vector<float> backwards = evaluate(noise, {columns[9], columns[2]}, {rows[5]});
  EXPECT_EQ(backwards[0], all[5 * columns.size() + 9]);
  EXPECT_EQ(backwards[1], all[5 * columns.size() + 2]);
}

TEST(RidgedNoise, LooksTheSameAlongBothAxes) {
  double along_x = 0, along_z = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const RidgedNoise noise({.seed = seed, .cells_per_step = 0.02});
    const auto axis = range(0, 1, 128);
    const std::vector<float> v = evaluate(noise, axis, axis);
    for (std::size_t z = 0; z + 1 < 128; ++z) {
      for (std::size_t x = 0; x + 1 < 128; ++x) {
        along_x += std::pow(v[z * 128 + x + 1] - v[z * 128 + x], 2);
        along_z += std::pow(v[(z + 1) * 128 + x] - v[z * 128 + x], 2);
      }
    }
  }
  EXPECT_NEAR(along_x / along_z, 1, 0.1);
}

TEST(RidgedNoise, LooksTheSameInEveryDirection) {
  // Mean squared difference of points five steps apart, in six directions.
  constexpr std::array<std::array<int, 2>, 6> kWays{
      {{5, 0}, {4, 3}, {3, 4}, {0, 5}, {-3, 4}, {-4, 3}}};
  std::array<double, kWays.size()> energy{};
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const RidgedNoise noise({.seed = seed, .cells_per_step = 0.02});
    const auto axis = range(0, 1, 128);
    const std::vector<float> v = evaluate(noise, axis, axis);
    for (std::size_t w = 0; w < kWays.size(); ++w) {
      for (int z = 0; z < 123; ++z) {
        for (int x = 5; x < 123; ++x) {
          const auto here = static_cast<std::size_t>(z * 128 + x);
          const auto there = static_cast<std::size_t>((z + kWays[w][1]) * 128 + x + kWays[w][0]);
          energy[w] += std::pow(v[there] - v[here], 2);
        }
      }
    }
  }
  double mean = 0;
  for (const double e : energy)
    mean += e / kWays.size();
  for (const double e : energy)
    EXPECT_NEAR(e / mean, 1, 0.12);
}

TEST(RidgedNoise, WorkCountsSamplesAndOctavesNarrowerThanTheirSpacing) {
  RidgedSettings settings;
  settings.cells_per_step = 1e-6;
  const double wide = RidgedNoise(settings).work(64, 64, 1);
  EXPECT_NEAR(wide, 64 * 64 * settings.octaves, 0.01 * wide);
  EXPECT_DOUBLE_EQ(RidgedNoise(settings).work(128, 64, 1), 2 * wide);
  EXPECT_NEAR(RidgedNoise(settings).work(64, 64, 1, 3), wide / 3, 0.01 * wide);
  EXPECT_NEAR(RidgedNoise(settings).work(64, 64, 1e7), 9 * wide, 0.01 * wide);
  settings.warp = 0.2;
  EXPECT_GT(RidgedNoise(settings).work(64, 64, 1), 5 * wide);
}

TEST(RidgedNoise, TheFirstOctavesHaveALargestValueOfTheirOwn) {
  const RidgedNoise noise({.seed = 3, .octaves = 6, .cells_per_step = 0.03});
  const auto axis = range(0, 1, 140);
  std::vector<float> values(axis.size() * axis.size());
  for (int octaves = 1; octaves <= 6; ++octaves) {
    noise.evaluate(axis, axis, values, axis.size(), octaves);
    const double largest = static_cast<double>(*std::ranges::max_element(values));
    EXPECT_LE(largest, noise.max_value(octaves));
    EXPECT_GT(largest, 0.5 * noise.max_value(octaves)) << octaves;
    EXPECT_GT(noise.max_value(octaves), noise.max_value(octaves - 1));
  }
  EXPECT_NEAR(noise.max_value(6), noise.max_value(), 1e-6 * noise.max_value());
  EXPECT_EQ(noise.max_value(99), noise.max_value());
}

TEST(RidgedNoise, WithoutGainEqualsItsFirstOctave) {
  for (const double gain : {0.0, 1e-300, 1e-12, 1e-7, 0.01}) {
    const TerrainOracle oracle{.seed = 4, .gain = gain, .cells_per_step = 0.03};
    const auto axis = range(-5, 3, 9);
    const std::vector<float> values = evaluate(RidgedNoise(settings_of(oracle)), axis, axis);
    for (std::size_t i = 0; i < values.size(); ++i)
      ASSERT_NEAR(values[i], oracle.value(axis[i % 9], axis[i / 9]), 1e-5 * oracle.max_value());
  }
}

TEST(RidgedNoise, NeighbouringSeedsAndOctavesAreUnrelated) {
  // One sample per lattice cell, at the same position in each: only hashes differ between samples.
  const auto axis = range(1, 4, 128);
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const RidgedNoise a({.seed = seed, .octaves = 2, .cells_per_step = 0.25});
    const RidgedNoise b({.seed = seed + 1, .octaves = 2, .cells_per_step = 0.25});
    EXPECT_LT(std::abs(correlation(evaluate(a, axis, axis), evaluate(b, axis, axis))), 0.05);
  }
}

TEST(ExactMath, PowersEqualThoseOfTheLibrary) {
  core::RandomStream random(1, 0, 0, 0, core::Purpose::kParameters);
  for (int i = 0; i < 2000; ++i) {
    const double base = random.next_real(1e-3, 1e3), exponent = random.next_real(-4, 4);
    EXPECT_NEAR(exact_pow(base, exponent) / std::pow(base, exponent), 1, 1e-13);
  }
  EXPECT_EQ(exact_pow(2, 0), 1);
  EXPECT_EQ(exact_pow(1, -3.7), 1);
}

}  // namespace
}  // namespace psygen::models
