// Tests that ridged noise does not reveal its lattices: compares the contribution of every octave
// on its lattice lines and at its lattice points with that elsewhere, along both axes, with and
// without warp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/models/terrain/ridged_noise.hpp"
#include "tests/engine/models/oracle/terrain.hpp"

namespace psygen::models {
namespace {

using test::TerrainOracle;

constexpr int kOctaves = 9;
constexpr std::int64_t kFirstCell = 4096;  // integers in a lattice cell of octave 0
constexpr int kPhases = 16;                // positions in a lattice cell, from one line to the next
constexpr int kCells = 9;                  // of an axis; kCells · kPhases coordinates

// Settings with rough ground, so that fine octaves count.
TerrainOracle world(std::uint64_t seed, double warp) {
  return {.seed = seed,
          .height = 0.6,
          .offset = 0.88,
          .cells_per_step = 1.0 / kFirstCell,
          .octaves = kOctaves,
          .warp = warp};
}

std::int64_t cell_size(std::uint64_t octave) {
  return octave >= TerrainOracle::kWarp ? 2 * kFirstCell : kFirstCell >> octave;
}

// Coordinates that pass through lattice cells far apart, from one line to the next;
// `lattice_of_zero` is the lattice position of coordinate 0.
std::vector<std::int64_t> through_cells(std::uint64_t octave, std::uint64_t lattice_of_zero,
                                        core::RandomStream& random) {
  const std::int64_t size = cell_size(octave);
  const double fraction = static_cast<double>(lattice_of_zero & 0xFFFFFFFFU) * 0x1.0p-32;
  std::vector<std::int64_t> result;
  for (int cell = 0; cell < kCells; ++cell) {
    const std::int64_t line = random.next_integer(-100'000, 100'000) * size -
                              std::llround(fraction * static_cast<double>(size));
    for (int phase = 0; phase < kPhases; ++phase)
      result.push_back(line + phase * size / kPhases);
  }
  return result;
}

// Contributions of an octave in its lattice cells, or heights in the cells of the warp's field.
struct Samples {
  // [phase along x][phase along z], of one lattice cell after another
  std::vector<float> at[kPhases][kPhases];

  Samples(std::uint64_t octave, double warp) {
    core::RandomStream random(7, 0, 0, 0, core::Purpose::kParameters);
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
      const TerrainOracle o = world(seed, warp);
      const RidgedNoise noise(
          {o.seed, o.height, o.lacunarity, o.octaves, o.offset, o.gain, o.cells_per_step, o.warp});
      const auto columns = through_cells(octave, o.lattice_x(octave, 0), random);
      const auto rows = through_cells(octave, o.lattice_z(octave, 0), random);
      std::vector<float> values(columns.size() * rows.size());
      const bool field = octave >= TerrainOracle::kWarp;
      const int before = field ? 0 : static_cast<int>(octave);
      noise.evaluate(columns, rows, values, columns.size(), field ? kOctaves : before + 1);
      if (before > 0) {
        std::vector<float> coarser(values.size());
        noise.evaluate(columns, rows, coarser, columns.size(), before);
        for (std::size_t i = 0; i < values.size(); ++i)
          values[i] -= coarser[i];
      }
      for (std::size_t i = 0; i < values.size(); ++i)
        at[i % columns.size() % kPhases][i / columns.size() % kPhases].push_back(values[i]);
    }
  }
  // Returns the samples of phases that satisfy chosen(along x, along z).
  template <class Chosen>
  std::vector<float> of(Chosen chosen) const {
    std::vector<float> result;
    for (int x = 0; x < kPhases; ++x) {
      for (int z = 0; z < kPhases; ++z)
        if (chosen(x, z)) result.insert(result.end(), at[x][z].begin(), at[x][z].end());
    }
    return result;
  }
};

struct Moments {
  double mean = 0, deviation = 0;
  explicit Moments(const std::vector<float>& values) {
    double squares = 0;
    for (const float v : values) {
      mean += static_cast<double>(v) / static_cast<double>(values.size());
      squares += static_cast<double>(v) * static_cast<double>(v);
    }
    deviation = std::sqrt(squares / static_cast<double>(values.size()) - mean * mean);
  }
};

struct Lattice {
  std::uint64_t octave;  // or TerrainOracle::kWarp, + 1
  double warp;
};

class RidgedLattice : public ::testing::TestWithParam<Lattice> {
 protected:
  Samples samples{GetParam().octave, GetParam().warp};
  std::vector<float> everywhere = samples.of([](int, int) { return true; });
  Moments all{everywhere};
};

TEST_P(RidgedLattice, LinesAreNoHigherAndNoLowerThanOtherGround) {
  for (int phase = 0; phase < kPhases; ++phase) {
    const Moments along_z(samples.of([&](int x, int) { return x == phase; }));
    const Moments along_x(samples.of([&](int, int z) { return z == phase; }));
    EXPECT_NEAR(along_z.mean, all.mean, 0.1 * all.deviation) << "phase along x " << phase;
    EXPECT_NEAR(along_x.mean, all.mean, 0.1 * all.deviation) << "phase along z " << phase;
    EXPECT_NEAR(along_z.deviation / all.deviation, 1, 0.1) << "phase along x " << phase;
    EXPECT_NEAR(along_x.deviation / all.deviation, 1, 0.1) << "phase along z " << phase;
  }
}

TEST_P(RidgedLattice, PointsAreLikeOtherGround) {
  std::nth_element(everywhere.begin(), everywhere.end() - everywhere.size() / 10, everywhere.end());
  const float high = *(everywhere.end() - everywhere.size() / 10);
  const std::vector<float> points = samples.of([](int x, int z) { return x == 0 && z == 0; });
  const Moments m(points);
  EXPECT_NEAR(m.mean, all.mean, 0.15 * all.deviation);
  EXPECT_NEAR(m.deviation / all.deviation, 1, 0.2);
  const auto highest =
      std::count_if(points.begin(), points.end(), [&](float v) { return v > high; });
  EXPECT_NEAR(static_cast<double>(highest) / static_cast<double>(points.size()), 0.1, 0.05);
}

std::vector<Lattice> lattices() {
  std::vector<Lattice> result;
  for (const double warp : {0.0, 0.5}) {
    for (std::uint64_t o = 0; o < kOctaves; ++o)
      result.push_back({o, warp});
  }
  result.push_back({TerrainOracle::kWarp, 0.5});
  result.push_back({TerrainOracle::kWarp + 1, 0.5});
  return result;
}

std::string name_of(const ::testing::TestParamInfo<Lattice>& info) {
  const auto [octave, warp] = info.param;
  const bool field = octave >= TerrainOracle::kWarp;
  return (field ? "field" : "octave") +
         std::to_string(field ? octave - TerrainOracle::kWarp : octave) +
         (warp > 0 && !field ? "warped" : "");
}

INSTANTIATE_TEST_SUITE_P(All, RidgedLattice, ::testing::ValuesIn(lattices()), name_of);

}  // namespace
}  // namespace psygen::models
