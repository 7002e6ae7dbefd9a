// The ground and the water of river networks.
#include "engine/models/network/network.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine/models/kit/simd_targets.hpp"
#include "tests/engine/models/network/networks.hpp"

namespace psygen::models {
namespace {

using network::kUnitsPerCell;
using river_tests::kFrame;
using river_tests::network_of;
using river_tests::Place;
using river_tests::places;
using river_tests::position_of;

// All results of some samples.
struct Result {
  std::vector<float> base, slope_x, slope_z, clear, height, water, flow_x, flow_z;
  std::vector<std::uint32_t> body;

  explicit Result(std::size_t size) : body(size) {
    for (auto* rows : {&base, &slope_x, &slope_z, &clear, &height, &water, &flow_x, &flow_z})
      rows->resize(size);
  }
  network::BaseRows base_rows(std::size_t stride) {
    return {.height_m = base.data(),
            .slope_x = slope_x.data(),
            .slope_z = slope_z.data(),
            .clear = clear.data(),
            .stride = stride};
  }
  network::CarvedRows carved_rows(std::size_t stride) {
    return {.base_m = base.data(),
            .base_stride = stride,
            .height_m = height.data(),
            .water_m = water.data(),
            .flow_x = flow_x.data(),
            .flow_z = flow_z.data(),
            .body = body.data(),
            .stride = stride};
  }
  std::uint64_t hash() const {
    std::uint64_t sum = core::hash_bytes(std::as_bytes(std::span(body)));
    for (const auto* rows : {&base, &slope_x, &slope_z, &clear, &height, &water, &flow_x, &flow_z})
      sum = core::hash_bytes(std::as_bytes(std::span(*rows)), sum);
    return sum;
  }
  friend bool operator==(const Result& a, const Result& b) { return a.hash() == b.hash(); }
};

std::vector<std::int64_t> range(std::int64_t first, std::int64_t step, int count) {
  std::vector<std::int64_t> result;
  for (int i = 0; i < count; ++i)
    result.push_back(first + i * step);
  return result;
}

Result evaluate(const RiverNetwork& network, const std::vector<std::int64_t>& x,
                const std::vector<std::int64_t>& z, GroundDetail detail = {}) {
  Result r(x.size() * z.size());
  network.base({x, z}, detail, r.base_rows(x.size()));
  r.height = r.base;
  network.carve({x, z}, detail, r.carved_rows(x.size()));
  return r;
}

// The results at points of one patch.
Result through(const RiverNetwork& network, const network::Square& square, std::int64_t border,
               int level, const std::vector<std::int64_t>& x, const std::vector<std::int64_t>& z) {
  const network::Scale scale(network.settings(), network.frame());
  network::RootNodes root(scale, [&](const network::TileKey& key) {
    return std::make_shared<const network::RootTile>(network::make_root_tile(scale, key, border));
  });
  const network::Patch patch = network::make_patch(
      scale,
      network::nodes_around(scale, root, level, network::surroundings_of(scale, level, square),
                            level),
      square);
  const auto relative = [](const std::vector<std::int64_t>& axis, std::int64_t origin) {
    std::vector<std::int32_t> units;
    for (const std::int64_t v : axis)
      units.push_back(static_cast<std::int32_t>(v * kUnitsPerCell - origin));
    return units;
  };
  const auto px = relative(x, patch.x), pz = relative(z, patch.z);
  Result r(x.size() * z.size());
  const network::Samples samples{px, pz, level == network.settings().halvings};
  network::base_rows(patch, samples, r.base_rows(x.size()));
  r.height = r.base;
  network::carve_rows(patch, samples, r.carved_rows(x.size()));
  return r;
}

void expect_pure(const RiverNetwork& network, const Place& place, int level) {
  const std::int64_t step = std::int64_t{1} << (network.settings().halvings - level);
  const auto x = range(place[0], 7 * step, 10), z = range(place[1], 6 * step, 10);
  const auto square = [&](std::int64_t west, std::int64_t north, std::int64_t side) {
    return network::Square{(place[0] - west * step) * kUnitsPerCell,
                           (place[1] - north * step) * kUnitsPerCell, side * step * kUnitsPerCell};
  };
  const Result a = through(network, square(0, 0, 64), 24, level, x, z);
  ASSERT_TRUE(a == through(network, square(700, 250, 1600), 31, level, x, z)) << place[0];
  ASSERT_TRUE(a == through(network, square(90, 431, 500), 47, level, x, z)) << place[0];
}

// Streams beside wide rivers depend on the farthest nodes.
TEST(RiverNetwork, HasTheSameBitsBesideWideRivers) {
  const auto network = network_of({.root_spacing_m = 4096, .halvings = 8, .channel_km2 = 0.002});
  std::vector<Place> wide;
  for (const Place& tile : places(8, 200'000)) {
    const auto patch = network->patch(network->tile_of(tile[0], tile[1], {}));
    for (const network::Curve& c : patch->curves) {
      if (c.width0_m < 12 || wide.size() >= 6) continue;
      const auto lattice = [](std::int64_t unit) { return unit / kUnitsPerCell; };
      wide.push_back({lattice(patch->x + c.x) - 40, lattice(patch->z + c.z) + 30});
    }
  }
  ASSERT_EQ(wide.size(), 6U);
  for (const Place& place : wide)
    expect_pure(*network, place, 8);
}

TEST(RiverNetwork, HasTheSameBitsThroughEveryTileAndRootBorder) {
  const auto network = network_of({});
  for (const Place& place : places(40, 2'000'000))
    expect_pure(*network, place, 7);
  for (const Place& place : places(8, 2'000'000))
    expect_pure(*network, place, 4);
  // The last blocks of the world.
  constexpr std::int64_t kEdge = (std::int64_t{1} << 31) * 63;
  for (const Place& place :
       {Place{kEdge - 70, -kEdge}, Place{-kEdge, kEdge - 70}, Place{-kEdge, 0}})
    expect_pure(*network, place, 7);
}

TEST(RiverNetwork, HasTheSameBitsInEveryBatch) {
  const auto network = network_of({.seed = 2});
  const std::int64_t tile = 32 * 63;  // samples cross tiles
  for (const int level : {0, 1, 2, 5, 9}) {
    const auto x = range(tile - 60, 3, 43), z = range(-51, 4, 31);
    const GroundDetail detail{level};
    const Result all = evaluate(*network, x, z, detail);
    for (std::size_t i = 0; i < x.size(); i += 5) {
      for (std::size_t k = 0; k < z.size(); k += 4) {
        const Result one = evaluate(*network, {x[i]}, {z[k]}, detail);
        const std::size_t at = k * x.size() + i;
        ASSERT_EQ(one.base[0], all.base[at]);
        ASSERT_EQ(one.slope_x[0], all.slope_x[at]);
        ASSERT_EQ(one.clear[0], all.clear[at]);
        ASSERT_EQ(one.height[0], all.height[at]);
        ASSERT_EQ(one.water[0], all.water[at]);
        ASSERT_EQ(one.body[0], all.body[at]);
      }
    }
  }
}

TEST(RiverNetwork, AnswersForOnePlaceAsForRows) {
  const auto network = network_of({.seed = 1});
  std::size_t wet = 0;
  for (const Place& place : places(30, 400'000)) {
    const auto x = range(place[0], 1, 64), z = range(place[1], 1, 64);
    Result r(64 * 64);
    network->evaluate({x, z}, {}, r.carved_rows(64));
    for (std::size_t k = 0; k < r.height.size(); k += 37) {
      const std::int64_t cx = x[k % 64], cz = z[k / 64];
      const core::WorldPosition at{{static_cast<std::int32_t>(network::floor_div(cx, 63)),
                                    static_cast<std::int32_t>(network::floor_div(cz, 63))},
                                   {static_cast<double>(cx - network::floor_div(cx, 63) * 63), 0,
                                    static_cast<double>(cz - network::floor_div(cz, 63) * 63)}};
      const NetworkWater water = network->water_at(at);
      ASSERT_EQ(water.depth_m > 0, r.water[k] > r.height[k]);
      if (water.depth_m <= 0) continue;
      ++wet;
      ASSERT_EQ(water.surface_m, r.water[k]);
      ASSERT_EQ(water.depth_m, r.water[k] - r.height[k]);
      ASSERT_EQ(water.flow_m_s.x, r.flow_x[k]);
      ASSERT_EQ(water.flow_m_s.y, r.flow_z[k]);
      ASSERT_EQ(water.body, r.body[k]);
      ASSERT_NE(water.body, 0U);
    }
  }
  EXPECT_GT(wet, 300U);
}

TEST(RiverNetwork, KnowsSquaresAndPlacesWithoutInlandWater) {
  std::size_t dry_squares = 0, free = 0, wet = 0, sea = 0;
  for (const RiverSettings& settings :
       {RiverSettings{.sea_share = 0.2},
        RiverSettings{.seed = 5, .root_spacing_m = 2048, .halvings = 5, .lake_share = 0.12}}) {
    const auto network = network_of(settings);
    for (const Place& place : places(150, 300'000)) {
      const bool may = network->may_have_water({place[0], place[1], 63});
      std::size_t wet_here = 0;
      for (std::int64_t i = 0; i < 22 * 22; ++i) {
        const core::WorldPosition at = position_of(static_cast<double>(place[0] + 3 * (i % 22)),
                                                   static_cast<double>(place[1] + 3 * (i / 22)));
        const NetworkWater water = network->water_at(at);
        const auto inland = network->inland_water_at(at);
        const bool is_sea = water.body == network::kSeaBody && water.depth_m > 0;
        ASSERT_EQ(inland.has_value(), water.depth_m > 0 && !is_sea);
        sea += is_sea ? 1 : 0;
        if (!inland) continue;
        ++wet_here;
        ASSERT_EQ(inland->water.surface_m, water.surface_m);
        ASSERT_EQ(inland->water.depth_m, water.depth_m);
        ASSERT_EQ(inland->water.flow_m_s, water.flow_m_s);
        ASSERT_EQ(inland->water.body, water.body);
      }
      wet += wet_here;
      ASSERT_TRUE(may || wet_here == 0) << place[0] << " " << place[1];
      dry_squares += wet_here == 0 ? 1 : 0;
      free += may ? 0 : 1;
    }
  }
  EXPECT_GT(wet, 500U);
  EXPECT_GT(sea, 500U);
  EXPECT_GT(10 * free, 8 * dry_squares) << free << " of " << dry_squares;
}

TEST(RiverNetwork, PartsCoverEverySquareOnce) {
  // Patches of the root have 128 blocks a side; a node of level 9 has 512.
  const RiverSettings small{.root_spacing_m = 256, .halvings = 4};
  for (const auto& [settings, alone] :
       {std::pair{RiverSettings{}, true}, std::pair{small, false}}) {
    const auto network = network_of(settings);
    std::size_t most = 0;
    for (const int level : {0, 1, 4, 9}) {
      for (const core::BlockCoord corner :
           {core::BlockCoord{0, 0}, {-512, 1024}, {12800, -25600}}) {
        const RiverNetwork::Cells square = network->square_of(corner, level);
        EXPECT_EQ(square.side, 63 << level);
        EXPECT_EQ(square.x, std::int64_t{corner.x} * 63);
        const auto parts = network->parts_of(square, GroundDetail::of_node(level));
        most = std::max(most, parts.size());
        std::int64_t units2 = 0;
        std::vector<Place> corners;
        for (const auto& [patch, box] : parts) {
          EXPECT_TRUE(box.x0 >= patch->square.x - patch->x && box.z0 >= patch->square.z - patch->z);
          EXPECT_LE(box.x1 + patch->x, patch->square.x + patch->square.side);
          EXPECT_LE(box.z1 + patch->z, patch->square.z + patch->square.side);
          units2 += (std::int64_t{box.x1} - box.x0 + 1) * (std::int64_t{box.z1} - box.z0 + 1);
          corners.push_back({patch->x + box.x0, patch->z + box.z0});
        }
        EXPECT_EQ(units2, square.side * square.side * kUnitsPerCell * kUnitsPerCell);
        EXPECT_EQ(corners.front(), (Place{square.x * kUnitsPerCell, square.z * kUnitsPerCell}));
        EXPECT_TRUE(std::ranges::is_sorted(corners, {}, [](const Place& c) {
          return std::pair{c[1], c[0]};
        }));
        EXPECT_EQ(std::ranges::adjacent_find(corners), corners.end());
      }
    }
    EXPECT_EQ(most == 1, alone) << most;
  }
}

TEST(RiverNetwork, HasTheSameBitsOnEveryInstructionSet) {
  const auto network = network_of({.seed = 3});
  for (const Place& place : places(6, 500'000)) {
    for (const int level : {0, 4, 8}) {
      const auto x = range(place[0], 1 + 3 * level, 67), z = range(place[1], 1 + 3 * level, 21);
      pin_simd_target(simd_targets().front());
      const Result best = evaluate(*network, x, z, {level});
      for (const std::string_view target : simd_targets()) {
        pin_simd_target(target);
        EXPECT_TRUE(evaluate(*network, x, z, {level}) == best) << target;
      }
    }
  }
  unpin_simd_target();
}

// Every curve of some tiles, walked from its beginning to its end.
struct Walk {
  std::int64_t steps = 0, rises = 0, dry = 0, below_bed = 0;
  float worst_m = 0;
};

Walk walk(const RiverNetwork& network, const Place& place, float beside) {
  Walk w;
  const auto patch = network.patch(network.tile_of(place[0], place[1], {}));
  constexpr int kSteps = 13;
  for (const network::Curve& c : patch->curves) {
    float last = std::numeric_limits<float>::infinity();
    for (int k = c.head ? 8 : 0; k <= kSteps; ++k) {
      const double t = static_cast<double>(k) / kSteps * c.chords / network::Curve::kChords;
      const auto s = std::min<std::size_t>(static_cast<std::size_t>(t * network::Curve::kChords),
                                           network::Curve::kChords - 1);
      const double f = t * network::Curve::kChords - static_cast<double>(s);
      const double ex = c.px[s + 1] - c.px[s], ez = c.pz[s + 1] - c.pz[s];
      const double size = std::max(1e-6, std::sqrt(ex * ex + ez * ez));
      const double aside =
          static_cast<double>(beside) * 0.5 * (c.width0_m + t * (c.width1_m - c.width0_m));
      const auto unit = [&](double metres) {
        return static_cast<std::int32_t>(std::lround(metres / static_cast<double>(patch->unit_m)));
      };
      const std::int32_t x = c.x + unit(c.px[s] + f * ex - aside * ez / size);
      const std::int32_t z = c.z + unit(c.pz[s] + f * ez + aside * ex / size);
      if (x < 0 || z < 0 || x > patch->square.side || z > patch->square.side) {
        last = std::numeric_limits<float>::infinity();
        continue;
      }
      Result r(1);
      const network::Samples at{{&x, 1}, {&z, 1}, true};
      network::base_rows(*patch, at, r.base_rows(1));
      r.height = r.base;
      network::carve_rows(*patch, at, r.carved_rows(1));
      ++w.steps;
      if (r.water[0] == network::kDry) {
        ++w.dry;
        continue;
      }
      w.below_bed += r.water[0] <= r.height[0] ? 1 : 0;
      if (r.water[0] > last + 0.01F) {
        ++w.rises;
        w.worst_m = std::max(w.worst_m, r.water[0] - last);
      }
      last = r.water[0];
    }
  }
  return w;
}

Walk walk_all(float beside) {
  Walk all;
  for (const RiverSettings& settings :
       {RiverSettings{}, RiverSettings{.seed = 5, .root_spacing_m = 2048, .halvings = 5}}) {
    const auto network = network_of(settings);
    for (const Place& place : places(25, 600'000)) {
      const Walk w = walk(*network, place, beside);
      all.steps += w.steps;
      all.rises += w.rises;
      all.dry += w.dry;
      all.below_bed += w.below_bed;
      all.worst_m = std::max(all.worst_m, w.worst_m);
    }
  }
  return all;
}

TEST(RiverNetwork, WaterNeverRisesDownstream) {
  const Walk middle = walk_all(0);
  EXPECT_GT(middle.steps, 100'000);
  EXPECT_EQ(middle.rises, 0) << middle.worst_m;
  EXPECT_EQ(middle.dry, 0);
  EXPECT_EQ(middle.below_bed, 0);
  // Beside the middle, blended water of two channels may rise, rarely.
  const Walk beside = walk_all(0.4F);
  EXPECT_LE(beside.rises * 10'000, beside.steps);
  EXPECT_LT(beside.worst_m, 3.0F);
  EXPECT_EQ(beside.dry, 0);
}

TEST(RiverNetwork, WaterHasBanks) {
  const auto network = network_of({.sea_share = 0.1});
  std::size_t wet = 0, leaks = 0;  // water beside dry ground over a metre lower
  constexpr std::size_t kSide = 400;
  for (const Place& place : places(20, 400'000)) {
    const auto x = range(place[0], 1, kSide), z = range(place[1], 1, kSide);
    Result r(kSide * kSide);
    network->evaluate({x, z}, {}, r.carved_rows(kSide));
    const auto dry_below = [&](std::size_t at, float level_m) {
      return r.water[at] == RiverNetwork::kDry && r.height[at] < level_m - 1;
    };
    for (std::size_t at = kSide; at < r.height.size() - kSide; ++at) {
      if (r.water[at] == RiverNetwork::kDry || at % kSide == 0 || at % kSide == kSide - 1) continue;
      ++wet;
      const float level = r.water[at];
      leaks += dry_below(at - 1, level) || dry_below(at + 1, level) ||
                       dry_below(at - kSide, level) || dry_below(at + kSide, level)
                   ? 1
                   : 0;
    }
  }
  EXPECT_GT(wet, 20'000U);
  EXPECT_LT(leaks * 500, wet) << leaks;
}

TEST(RiverNetwork, GroundStaysWithinItsBounds) {
  const auto network = network_of({.seed = 4, .mountain_share = 0.8});
  double truth = 0, bound = 0;
  for (const Place& place : places(60, 500'000)) {
    for (const int level : {0, 5, 8}) {
      const auto x = range(place[0], 1 << std::max(0, level - 1), 64);
      const auto z = range(place[1], 1 << std::max(0, level - 1), 64);
      const Result r = evaluate(*network, x, z, {level});
      const std::int64_t side = x.back() - x.front();
      const network::HeightRange range = network->bounds({place[0], place[1], side}, {level});
      const auto [low, high] = std::minmax_element(r.height.begin(), r.height.end());
      ASSERT_GE(*low, range.lowest_m);
      ASSERT_LE(*high, range.highest_m);
      ASSERT_GE(*low, network->bounds().lowest_m);
      ASSERT_LE(*high, network->bounds().highest_m);
      truth += static_cast<double>(*high - *low);
      bound += static_cast<double>(range.highest_m - range.lowest_m);
    }
  }
  EXPECT_LT(bound, 8 * truth);
}

TEST(RiverNetwork, CoarseGroundKeepsItsErrorAndItsMean) {
  const auto network = network_of({.seed = 8, .mountain_share = 0.9, .sea_share = 0.1});
  for (const int level : {6, 7, 8, 9}) {
    double mean = 0, fine_mean = 0;
    std::size_t count = 0, far = 0;
    for (const Place& place : places(60, 400'000)) {
      const auto x = range(place[0], 97, 16), z = range(place[1], 97, 16);
      const Result fine = evaluate(*network, x, z), coarse = evaluate(*network, x, z, {level});
      for (std::size_t k = 0; k < fine.base.size(); ++k) {
        if (fine.base[k] < 210) continue;
        ++count;
        mean += static_cast<double>(coarse.base[k] - fine.base[k]);
        fine_mean += static_cast<double>(fine.base[k]);
        far += std::abs(coarse.base[k] - fine.base[k]) > network->error_m({0}, {level}) ? 1 : 0;
      }
    }
    ASSERT_GT(count, 5000U);
    EXPECT_LT(far * 200, count) << level;
    EXPECT_LT(std::abs(mean), 0.03 * fine_mean) << level;
  }
  EXPECT_EQ(network->level_of({6}), 7);
  EXPECT_EQ(network->level_of({7}), 6);
  EXPECT_EQ(network->level_of({40}), 0);
  EXPECT_EQ(network->error_m({0}, {0}), 0);
}

TEST(RiverNetwork, KeepsItsBits) {
  // A change here changes worlds: raise RiverSettings::kEdition with it.
  std::uint64_t hash = 0;
  for (const RiverSettings& settings :
       {RiverSettings{}, RiverSettings{.seed = 5, .root_spacing_m = 2048, .halvings = 5}}) {
    const auto network = network_of(settings);
    for (const Place& place : places(20, 300'000)) {
      for (const int level : {0, 3, 8})
        hash = core::combine(
            hash,
            evaluate(*network, range(place[0], 5, 33), range(place[1], 5, 33), {level}).hash());
    }
  }
  EXPECT_EQ(hash, 0x2172035424AB7F84ULL);
}

TEST(RiverNetwork, AtTheEndsOfItsSettingsHasFiniteGround) {
  std::vector<RiverSettings> all;
  all.push_back({.sea_share = 1});
  all.push_back({.sea_share = 0});
  all.push_back({.lake_share = 0, .mountain_share = 0, .steepness = 0.05});
  all.push_back({.lake_share = 0.12, .mountain_share = 1, .steepness = 3});
  all.push_back({.root_spacing_m = 65536, .halvings = 8});
  all.push_back({.root_spacing_m = 256, .halvings = 1, .channel_km2 = 1000});
  all.push_back({.root_spacing_m = 4096, .halvings = 8, .channel_km2 = 1e-4});
  for (const RiverSettings& settings : all) {
    ASSERT_TRUE(check(settings, kFrame).has_value());
    const auto network = network_of(settings);
    for (const Place& place : places(4, 100'000)) {
      for (const int level : {0, 6, 30}) {
        const Result r =
            evaluate(*network, range(place[0], 3, 20), range(place[1], 3, 20), {level});
        for (std::size_t k = 0; k < r.height.size(); ++k) {
          ASSERT_GE(r.height[k], 0);
          ASSERT_LE(r.height[k], 2000);
          ASSERT_TRUE(std::isfinite(r.slope_x[k]) && std::isfinite(r.flow_x[k]));
          ASSERT_TRUE(r.clear[k] >= 0 && r.clear[k] <= 1);
        }
      }
    }
  }
}

}  // namespace
}  // namespace psygen::models
