#include "engine/models/ground/erosion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/models/kit/simd_targets.hpp"
#include "engine/models/terrain/ridged_noise.hpp"

namespace psygen::models {
namespace {

using Axis = std::vector<std::int64_t>;

// Mountains of ridged noise as a guide; heights are in units of the noise.
struct Mountains final : ErosionGuide {
  RidgedNoise noise{{.seed = 71,
                     .height = 1.15,
                     .lacunarity = 2.03,
                     .octaves = 9,
                     .offset = 0.98,
                     .gain = 1.8,
                     .cells_per_step = 1.0 / 720}};
  void heights(std::span<const std::int64_t> columns, std::span<const std::int64_t> rows,
               double narrowest_cells, std::span<float> values, std::size_t stride) const override {
    noise.evaluate(columns, rows, values, stride, noise.octaves_wider_than(narrowest_cells));
  }
  ErosionScale scale() const {
    return {.seed = 71,
            .cell_m = 1,
            .unit_m = 330 / noise.max_value(),
            .highest = static_cast<float>(noise.max_value())};
  }
};

// A plane that rises along x, or level ground.
struct Plane final : ErosionGuide {
  double slope;
  explicit Plane(double rise) : slope(rise) {}
  void heights(std::span<const std::int64_t> columns, std::span<const std::int64_t> rows, double,
               std::span<float> values, std::size_t stride) const override {
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t c = 0; c < columns.size(); ++c)
        values[r * stride + c] = static_cast<float>(1e4 + slope * static_cast<double>(columns[c]));
    }
  }
};

Axis range(std::int64_t first, std::int64_t step, int count) {
  Axis axis;
  for (int i = 0; i < count; ++i)
    axis.push_back(first + i * step);
  return axis;
}

// All of the noise, or the guide alone, then the erosion.
std::vector<float> eroded(const ErosionFilter& filter, const Mountains& ground, const Axis& columns,
                          const Axis& rows) {
  std::vector<float> values(columns.size() * rows.size());
  ground.noise.evaluate(columns, rows, values, columns.size());
  filter.apply(ground, columns, rows, values, columns.size());
  return values;
}

Erosion usual() {
  Erosion e;
  e.strength = 0.5;
  return e;
}
Erosion everything() {
  Erosion e = usual();
  e.strata = 0.7;
  e.min_height_m = 20;
  e.max_height_m = 280;
  return e;
}

class ErosionTest : public ::testing::Test {
 protected:
  ~ErosionTest() override { unpin_simd_target(); }

  Mountains ground;
  core::RandomStream random{9, 0, 0, 0, core::Purpose::kParameters};

  Erosion random_erosion() {
    Erosion e = usual();
    visit_erosion(e, [&](std::string_view, auto& field, const NumberSpec& spec) {
      using Number = std::remove_reference_t<decltype(field)>;
      field = static_cast<Number>(random.next_real(spec.soft.min, spec.soft.max));
    });
    e.max_height_m = e.min_height_m + random.next_real(50, 400);
    return e;
  }
  std::int64_t random_place() {
    const std::int64_t reach = random.next_integer(0, 1) == 0 ? 1 << 20 : 63LL << 31;
    return random.next_integer(-reach, reach);
  }
};

TEST_F(ErosionTest, HasTheSameBitsOnEveryInstructionSet) {
  for (int trial = 0; trial < 24; ++trial) {
    const int detail = trial % 8;
    const ErosionFilter filter(random_erosion(), ground.scale(), detail);
    const std::int64_t step = detail == 0 ? 1 : std::int64_t{1} << (detail - 1);
    Axis columns = range(random_place(), step, 40), rows = range(random_place(), step, 9);
    if (trial % 3 == 0) {  // no order, large gaps
      for (std::int64_t& x : columns)
        x += random.next_integer(-900, 900);
    }
    pin_simd_target(simd_targets().front());
    const std::vector<float> best = eroded(filter, ground, columns, rows);
    for (const std::string_view target : simd_targets()) {
      pin_simd_target(target);
      const std::vector<float> values = eroded(filter, ground, columns, rows);
      ASSERT_EQ(std::memcmp(values.data(), best.data(), values.size() * sizeof(float)), 0)
          << target << " trial " << trial;
    }
  }
}

TEST_F(ErosionTest, HasTheSameBitsInAnyGroupingOfSamples) {
  for (const std::int64_t place : Axis{-3000, 63LL << 31, -(63LL << 31)}) {
    const ErosionFilter filter(everything(), ground.scale(), 0);
    const auto columns = range(place, 1, 130), rows = range(place / 2 + 77, 1, 70);
    const std::vector<float> all = eroded(filter, ground, columns, rows);
    for (const std::size_t step : {2U, 3U, 9U, 64U}) {
      for (std::size_t r = 0; r < rows.size(); r += step) {
        Axis some;
        for (std::size_t c = r % 2; c < columns.size(); c += step)
          some.push_back(columns[c]);
        const std::vector<float> values = eroded(filter, ground, some, {rows[r]});
        for (std::size_t i = 0; i < some.size(); ++i)
          ASSERT_EQ(values[i], all[r * columns.size() + r % 2 + i * step]);
      }
    }
    const std::vector<float> backwards =
        eroded(filter, ground, {columns[90], columns[2]}, {rows[5]});
    EXPECT_EQ(backwards[0], all[5 * columns.size() + 90]);
    EXPECT_EQ(backwards[1], all[5 * columns.size() + 2]);
  }
}

TEST_F(ErosionTest, HasTheSameBitsAtAllPlacesThatNodesOfALevelShare) {
  // Neighbouring nodes sample their border each; a wide call is split inside.
  for (int detail = 2; detail < 9; ++detail) {
    const ErosionFilter filter(everything(), ground.scale(), detail);
    const std::int64_t step = std::int64_t{1} << (detail - 1);
    const auto left = range(-63 * step, step, 64), right = range(0, step, 64),
               both = range(-63 * step, step, 127), rows = range(63 * step, step, 20);
    const std::vector<float> a = eroded(filter, ground, left, rows),
                             b = eroded(filter, ground, right, rows),
                             c = eroded(filter, ground, both, rows);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      EXPECT_EQ(a[r * 64 + 63], b[r * 64]);
      for (std::size_t i = 0; i < 64; ++i) {
        ASSERT_EQ(a[r * 64 + i], c[r * 127 + i]);
        ASSERT_EQ(b[r * 64 + i], c[r * 127 + 63 + i]);
      }
    }
  }
}

TEST_F(ErosionTest, StaysWithinItsBoundsForAMillionSamples) {
  double least = 0, most = 0;
  for (int trial = 0; trial < 64; ++trial) {
    Erosion e = trial % 2 == 0 ? usual() : random_erosion();
    e.wear = 0;
    ErosionScale scale = ground.scale();
    scale.highest = 1e6F;
    const ErosionFilter filter(e, scale, trial % 5);
    const auto columns = range(random_place(), 1, 128), rows = range(random_place(), 1, 128);
    std::vector<float> values(128 * 128, 1000.0F);
    filter.apply(ground, columns, rows, values, 128);
    for (const float value : values) {
      const double change = (static_cast<double>(value) - 1000) * scale.unit_m;
      ASSERT_GE(change, filter.min_m() - 0.05);
      ASSERT_LE(change, filter.max_m() + 0.05);
      if (trial % 2 != 0) continue;
      least = std::min(least, change / filter.min_m() * -1);
      most = std::max(most, change / filter.max_m());
    }
  }
  EXPECT_LT(least, -0.5);  // the bounds are not wide for nothing
  EXPECT_GT(most, 0.5);
}

TEST_F(ErosionTest, DiffersBetweenDetailsByNoMoreThanItSays) {
  for (Erosion e : {usual(), everything(), random_erosion(), random_erosion()}) {
    e.wear = 0;
    for (int detail = 1; detail < 9; ++detail) {
      const ErosionFilter fine(e, ground.scale(), detail - 1), coarse(e, ground.scale(), detail);
      const auto columns = range(random_place(), 7, 60), rows = range(random_place(), 7, 60);
      const std::vector<float> a = eroded(fine, ground, columns, rows),
                               b = eroded(coarse, ground, columns, rows);
      double error = 0;
      for (std::size_t i = 0; i < a.size(); ++i)
        error = std::max(error, std::abs(static_cast<double>(a[i] - b[i])) * ground.scale().unit_m);
      EXPECT_LE(error, fine.error_m(coarse) + 0.01) << detail;
    }
    EXPECT_EQ(ErosionFilter(e, ground.scale(), 3).error_m(ErosionFilter(e, ground.scale(), 3)), 0);
  }
}

TEST_F(ErosionTest, LeavesOutNarrowGulliesAtCoarseDetails) {
  // The mean square of second differences over neighbouring cells, on a slope.
  Erosion e = usual();
  e.octaves = 6;
  e.sediment_m = 0;
  double rough = 1e30;
  for (int detail = 0; detail < 6; ++detail) {
    const ErosionFilter filter(e, {.seed = 3, .highest = 1e6F}, detail);
    const auto axis = range(500, 1, 140);
    std::vector<float> values(140 * 140, 1e4F);
    filter.apply(Plane(0.7), axis, axis, values, 140);
    double sum = 0;
    for (std::size_t i = 140; i + 140 < values.size(); ++i)
      sum += std::pow(values[i - 140] + values[i + 140] - 2 * values[i], 2);
    EXPECT_LT(sum, detail < 2 ? rough : 0.7 * rough) << detail;
    rough = sum;
  }
}

TEST_F(ErosionTest, AddsNoSteepSteps) {
  // One step in a thousand exceeds 1.5 m over 1 m where the guide itself is not steeper.
  Erosion e = usual();
  e.wear = 0;
  ErosionScale scale = ground.scale();
  scale.highest = 1e6F;
  const ErosionFilter filter(e, scale, 0);
  double steepest = 0, steep = 0, squares = 0, count = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const auto columns = range(random_place(), 1, 128), rows = range(random_place(), 1, 128);
    std::vector<float> values(128 * 128, 1000.0F), guide(values.size());
    filter.apply(ground, columns, rows, values, 128);
    ground.heights(columns, rows, filter.narrowest_cells(), guide, 128);
    for (std::size_t i = 0; i + 129 < values.size(); ++i) {
      for (const std::size_t next : {std::size_t{1}, std::size_t{128}}) {
        if (next == 1 && i % 128 == 127) continue;
        const double step = std::abs(values[i + next] - values[i]) * scale.unit_m;
        const double base = std::abs(guide[i + next] - guide[i]) * scale.unit_m;
        steepest = std::max(steepest, step - std::max(base - 1.5, 0.0));
        steep += step > 1.5 ? 1 : 0;
        squares += step * step;
        ++count;
      }
    }
  }
  EXPECT_LT(steepest, 2.2);
  EXPECT_LT(steep / count, 1e-3);
  EXPECT_GT(std::sqrt(squares / count), 0.1);  // and yet there are gullies
}

TEST_F(ErosionTest, RunsDownTheSlope) {
  Erosion e = usual();
  e.octaves = 1;
  e.wear = 0;
  const ErosionFilter filter(e, {.seed = 3, .highest = 1e6F}, 0);
  double down = 0, across = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const auto columns = range(random_place(), 3, 100), rows = range(random_place(), 3, 100);
    std::vector<float> values(100 * 100, 1e4F);
    filter.apply(Plane(0), columns, rows, values, 100);
    for (const float value : values)
      ASSERT_EQ(value, 1e4F);  // level ground has no gullies
    std::ranges::fill(values, 100.0F);
    filter.apply(Plane(0.6), range(500, 3, 100), rows, values, 100);
    for (std::size_t i = 0; i + 101 < values.size(); ++i) {
      if (i % 100 == 99) continue;
      down += std::pow(values[i + 1] - values[i], 2);
      across += std::pow(values[i + 100] - values[i], 2);
    }
  }
  EXPECT_GT(across, 4 * down);
}

TEST_F(ErosionTest, TurnsSmallGulliesTowardsWiderOnes) {
  // On a plane, small gullies alone run downhill; over wider ones they drain to their beds.
  const auto across_share = [](const Erosion& e) {
    const auto columns = range(500, 1, 140), rows = range(-900, 1, 140);
    std::vector<float> wide(140 * 140, 100.0F), all(wide);
    Erosion one = e;
    one.octaves = 1;
    ErosionFilter(one, {.seed = 3, .highest = 1e6F}, 0).apply(Plane(0.6), columns, rows, wide, 140);
    ErosionFilter(e, {.seed = 3, .highest = 1e6F}, 0).apply(Plane(0.6), columns, rows, all, 140);
    double down = 0, across = 0;
    for (std::size_t i = 0; i + 141 < all.size(); ++i) {
      if (i % 140 == 139) continue;
      const auto fine = [&](std::size_t k) { return all[k] - wide[k]; };
      down += std::pow(fine(i + 1) - fine(i), 2);
      across += std::pow(fine(i + 140) - fine(i), 2);
    }
    return down / across;
  };
  Erosion straight = usual();
  straight.octaves = 2;
  straight.sediment_m = 0;
  straight.branching = 0;
  Erosion branching = straight;
  branching.branching = 1;
  EXPECT_GT(across_share(branching), 1.5 * across_share(straight));
}

TEST_F(ErosionTest, EndsAtItsHeights) {
  Erosion e = usual();
  e.min_height_m = 100;
  e.max_height_m = 200;
  e.height_fade_m = 20;
  const ErosionFilter filter(e, ground.scale(), 0);
  const double unit_m = ground.scale().unit_m;
  int outside = 0, changed = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const auto columns = range(random_place(), 2, 100), rows = range(random_place(), 2, 100);
    std::vector<float> before(100 * 100), low(before.size());
    ground.noise.evaluate(columns, rows, before, 100);
    ground.heights(columns, rows, filter.narrowest_cells(), low, 100);
    const std::vector<float> after = eroded(filter, ground, columns, rows);
    for (std::size_t i = 0; i < after.size(); ++i) {
      // The guide is the slow ground, smoothed over the lines of its lattice.
      const double height_m = static_cast<double>(low[i]) * unit_m;
      if (height_m < 80 || height_m > 220) {
        ++outside;
        ASSERT_EQ(after[i], before[i]) << height_m;
      } else {
        changed += after[i] != before[i] ? 1 : 0;
      }
    }
  }
  EXPECT_GT(outside, 10'000);
  EXPECT_GT(changed, 10'000);
}

TEST_F(ErosionTest, OfStrengthZeroChangesNoBit) {
  Erosion e = everything();
  e.strength = 0;
  const auto columns = range(-40, 1, 100), rows = range(7, 1, 100);
  std::vector<float> before(100 * 100);
  ground.noise.evaluate(columns, rows, before, 100);
  EXPECT_EQ(eroded(ErosionFilter(e, ground.scale(), 0), ground, columns, rows), before);
}

TEST_F(ErosionTest, OfExtremeNumbersKeepsHeightsInTheirRange) {
  for (int trial = 0; trial < 60; ++trial) {
    Erosion e = usual();
    visit_erosion(e, [&](std::string_view, auto& field, const NumberSpec& spec) {
      using Number = std::remove_reference_t<decltype(field)>;
      field = static_cast<Number>(random.next_integer(0, 1) == 0 ? spec.hard.min : spec.hard.max);
    });
    ErosionScale scale = ground.scale();
    scale.cell_m = trial % 3 == 0 ? 0.01 : trial % 3 == 1 ? 1 : 1000;
    const ErosionFilter filter(e, scale, trial % 21);
    const auto columns = range(random_place(), 1 << (trial % 5), 40),
               rows = range(random_place(), 5, 8);
    for (const float value : eroded(filter, ground, columns, rows)) {
      ASSERT_GE(value, 0.0F);
      ASSERT_LE(value, scale.highest);
    }
    EXPECT_GE(filter.error_m(ErosionFilter(e, scale, 0)), 0);
  }
}

TEST_F(ErosionTest, FillsValleysAndSparesCrests) {
  Erosion e = usual();
  e.wear = 0;
  e.valley_floor = e.scree = 1;
  Erosion bare = e;
  bare.sediment_m = 0;
  const ErosionFilter with(e, ground.scale(), 0), without(bare, ground.scale(), 0);
  double filled = 0, lowered = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const auto columns = range(random_place(), 4, 100), rows = range(random_place(), 4, 100);
    const auto a = eroded(with, ground, columns, rows), b = eroded(without, ground, columns, rows);
    for (std::size_t i = 0; i < a.size(); ++i) {
      filled += std::max(0.0, static_cast<double>(a[i] - b[i]));
      lowered += std::max(0.0, static_cast<double>(b[i] - a[i]));
    }
  }
  EXPECT_GT(filled, 2 * lowered);
}

TEST_F(ErosionTest, IsKnownByEachOfItsNumbers) {
  std::set<std::uint64_t> identities{usual().identity()};
  std::size_t fields = 0;
  const Erosion plain = usual();
  visit_erosion(plain, [&](std::string_view name, const auto&, const NumberSpec&) {
    Erosion e = usual();
    visit_erosion(e, [&](std::string_view other, auto& field, const NumberSpec& spec) {
      if (other != name) return;
      using Number = std::remove_reference_t<decltype(field)>;
      const auto low = static_cast<Number>(spec.soft.min);
      field = field == low ? static_cast<Number>(spec.soft.max) : low;
    });
    identities.insert(e.identity());
    ++fields;
  });
  EXPECT_EQ(identities.size(), fields + 1);
  EXPECT_FALSE(identities.contains(0));
}

TEST_F(ErosionTest, WorkGrowsWithSamplesAndOctaves) {
  Erosion e = usual();
  const ErosionFilter five(e, ground.scale(), 0);
  e.octaves = 2;
  const ErosionFilter two(e, ground.scale(), 0), coarse(usual(), ground.scale(), 7);
  EXPECT_GT(five.work(64, 64, 1), 1.5 * two.work(64, 64, 1));
  EXPECT_GT(five.work(128, 64, 1), 1.8 * five.work(64, 64, 1));
  EXPECT_LT(coarse.work(64, 64, 64), 0.3 * five.work(64, 64, 1));
  EXPECT_GT(five.guide_points(64, 64, 1), 16);
}

}  // namespace
}  // namespace psygen::models
