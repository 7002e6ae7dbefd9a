// All instruction sets of this CPU give the same bits, which are close to the double-precision
// oracles.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "engine/models/kit/packing.hpp"
#include "engine/models/kit/simd_targets.hpp"
#include "engine/models/rock/rock.hpp"
#include "engine/models/terrain/ridged_noise.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/models/oracle/rock.hpp"
#include "tests/engine/models/oracle/terrain.hpp"

namespace psygen::models {
namespace {

class SimdKernels : public ::testing::Test {
 protected:
  ~SimdKernels() override { unpin_simd_target(); }

  core::RandomStream random{5, 0, 0, 0, core::Purpose::kParameters};

  test::TerrainOracle random_terrain() {
    return {.seed = random.next_u64(),
            .height = random.next_real(0.3, 2),
            .lacunarity = random.next_real(1.2, 3.5),
            .offset = random.next_real(0, 1.5),
            .gain = random.next_real(0, 4),
            .cells_per_step = random.next_real(1e-4, 0.1),
            .octaves = static_cast<int>(random.next_integer(1, 16)),
            .warp = random.next_integer(0, 2) == 0 ? random.next_unit() : 0};
  }
  // Near or far, evenly spaced, or at random positions in no order.
  std::vector<std::int64_t> random_axis(std::int64_t longest) {
    const std::int64_t count = random.next_integer(1, longest);
    const std::int64_t first = random.next_integer(-(1LL << 40), 1LL << 40);
    const std::int64_t step = random.next_integer(1, random.next_integer(0, 1) == 0 ? 1 : 300);
    const bool uneven = random.next_integer(0, 3) == 0;
    std::vector<std::int64_t> axis;
    for (std::int64_t i = 0; i < count; ++i)
      axis.push_back(first + (uneven ? random.next_integer(-900, 900) : i * step));
    return axis;
  }
  // Expects the same bytes of all levels on every instruction set.
  void expect_same_bytes(const ModelType& type, const Parameters& p) {
    for (int level = 0; level < type.level_count(); ++level) {
      pin_simd_target(simd_targets().front());
      const test::Mesh best = test::synthesise(type, p, level);
      for (const std::string_view target : simd_targets()) {
        pin_simd_target(target);
        const test::Mesh mesh = test::synthesise(type, p, level);
        ASSERT_EQ(mesh.vertex_bytes, best.vertex_bytes) << target << " level " << level;
        ASSERT_EQ(mesh.box.min, best.box.min) << target << " level " << level;
        ASSERT_EQ(mesh.box.max, best.box.max) << target << " level " << level;
      }
    }
  }
};

RidgedNoise noise_of(const test::TerrainOracle& o) {
  return RidgedNoise(
      {o.seed, o.height, o.lacunarity, o.octaves, o.offset, o.gain, o.cells_per_step, o.warp});
}

TEST_F(SimdKernels, OfTerrainNoiseEqualTheOracleOnEveryTarget) {
  for (const std::string_view target : simd_targets()) {
    pin_simd_target(target);
    for (int trial = 0; trial < 20; ++trial) {
      const test::TerrainOracle oracle = random_terrain();
      const auto columns = random_axis(40), rows = random_axis(6);
      std::vector<float> values(columns.size() * rows.size());
      noise_of(oracle).evaluate(columns, rows, values, columns.size());
      for (std::size_t r = 0; r < rows.size(); ++r) {
        for (std::size_t c = 0; c < columns.size(); ++c)
          ASSERT_NEAR(values[r * columns.size() + c], oracle.value(columns[c], rows[r]),
                      1e-5 * oracle.max_value())
              << target;
      }
    }
  }
}

TEST_F(SimdKernels, OfTerrainNoiseHaveTheSameBitsOnEveryTarget) {
  constexpr std::size_t kGuard = 32;
  for (int trial = 0; trial < 60; ++trial) {
    const RidgedNoise noise = noise_of(random_terrain());
    const auto columns = random_axis(RidgedNoise::kMaxAxis), rows = random_axis(12);
    const std::size_t stride = columns.size() + static_cast<std::size_t>(trial % 3);
    std::vector<std::vector<float>> results;
    for (const std::string_view target : simd_targets()) {
      pin_simd_target(target);
      results.emplace_back(stride * rows.size() + kGuard, -7.0F);
      noise.evaluate(columns, rows, std::span(results.back()).first(stride * rows.size()), stride);
      ASSERT_EQ(results.back(), results.front()) << target;
    }
    // Only the samples were written.
    for (std::size_t i = 0; i < results[0].size(); ++i)
      ASSERT_EQ(results[0][i] == -7.0F, i % stride >= columns.size() || i >= stride * rows.size());
  }
}

// The few columns beyond whole vectors use rows as lanes if there are many rows.
TEST_F(SimdKernels, OfTerrainNoiseHaveTheSameBitsInTheLastColumns) {
  constexpr std::array<std::int64_t, 5> kRows{1, 16, 17, 65, 144};
  for (int trial = 0; trial < 120; ++trial) {
    const RidgedNoise noise = noise_of(random_terrain());
    const std::int64_t vectors = std::array{4, 8, 16, 64, 128}[static_cast<std::size_t>(trial % 5)];
    std::vector<std::int64_t> columns = random_axis(1), rows = columns;
    const std::int64_t step = trial % 4 == 0 ? random.next_integer(2, 90) : 1;
    while (static_cast<std::int64_t>(columns.size()) < vectors + trial % 4)
      columns.push_back(columns.back() + step);
    while (static_cast<std::int64_t>(rows.size()) < kRows[static_cast<std::size_t>(trial / 5 % 5)])
      rows.push_back(rows.back() + 1);
    std::vector<float> values(columns.size() * rows.size()), alone(rows.size());
    for (const std::string_view target : simd_targets()) {
      pin_simd_target(target);
      noise.evaluate(columns, rows, values, columns.size());
      for (std::size_t c = columns.size() - 4; c < columns.size(); ++c) {
        noise.evaluate(std::span(columns).subspan(c, 1), rows, alone, 1);
        for (std::size_t r = 0; r < rows.size(); ++r)
          ASSERT_EQ(values[r * columns.size() + c], alone[r]) << target << " column " << c;
      }
    }
  }
}

TEST_F(SimdKernels, OfTerrainMeshesWriteOnlyTheirRangeAtAnyAddressOnEveryTarget) {
  const auto type = make_terrain_type();
  constexpr std::size_t kGuard = 256;
  for (int trial = 0; trial < 32; ++trial) {
    Parameters p = test::random_parameters(*type, random);
    p.set_integer(kTerrainSize, random.next_integer(4, 128));
    const int level = trial % 4;
    const std::size_t bytes = type->mesh_size(p, level).vertex_count * sizeof(core::TerrainVertex);
    const auto at = static_cast<std::size_t>(kGuard + trial);
    for (const std::string_view target : simd_targets()) {
      pin_simd_target(target);
      const auto expected = test::synthesise(*type, p, level).vertex_bytes;
      std::vector<std::byte> memory(at + bytes + kGuard, std::byte{0xA5});
      type->synthesise(p, level, {std::span(memory).subspan(at, bytes), {}});
      ASSERT_TRUE(std::equal(expected.begin(), expected.end(), memory.begin() + at)) << target;
      for (std::size_t i = 0; i < memory.size(); ++i)
        ASSERT_TRUE((i >= at && i < at + bytes) || memory[i] == std::byte{0xA5}) << target;
    }
  }
}

TEST_F(SimdKernels, OfTerrainMeshesHaveTheSameBytesOnEveryTarget) {
  const auto type = make_terrain_type();
  for (int trial = 0; trial < 24; ++trial) {
    Parameters p = test::random_parameters(*type, random);
    p.set_integer(kTerrainSize, trial == 0 ? 64 : random.next_integer(4, 128));
    expect_same_bytes(*type, p);
  }
}

TEST_F(SimdKernels, OfRocksHaveTheSameBytesOnEveryTarget) {
  const auto type = make_rock_type();
  for (int trial = 0; trial < 36; ++trial) {
    Parameters p = test::random_parameters(*type, random);
    p.set_integer(kRockFamily, trial % kRockFamilyCount);
    p.set_integer(kRockSubdivisions, trial % 5);
    expect_same_bytes(*type, p);
  }
}

TEST_F(SimdKernels, OfRocksPlaceVerticesAsTheOracleOnEveryTarget) {
  const auto type = make_rock_type();
  for (const std::string_view target : simd_targets()) {
    pin_simd_target(target);
    for (int trial = 0; trial < 15; ++trial) {
      Parameters p = test::random_parameters(*type, random);
      p.set_integer(kRockFamily, trial % kRockFamilyCount);
      const test::RockOracle oracle = test::rock_oracle(p);
      const core::Bounds box = type->bounds(p);
      const test::Mesh mesh = test::synthesise(*type, p, 0);
      const auto vertices = mesh.vertices<core::ModelVertex>();
      const glm::vec3 tolerance =
          box.half_extent() / 60000.0F + static_cast<float>(1e-5 * oracle.radius);
      for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const glm::vec3 expected =
            oracle.places[static_cast<std::size_t>(oracle.triangles[i / 3][i % 3])];
        const glm::vec3 found = unpack_position(vertices[mesh.indices[i]], box);
        ASSERT_TRUE(glm::all(glm::lessThan(glm::abs(found - expected), tolerance))) << target;
      }
    }
  }
}

}  // namespace
}  // namespace psygen::models
