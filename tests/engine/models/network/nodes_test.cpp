// Nodes of river networks: roots, halvings, and the rivers that they form.
#include <gtest/gtest.h>

#include <unordered_map>

#include "engine/models/network/halving.hpp"
#include "tests/engine/models/network/drainage.hpp"
#include "tests/engine/models/network/networks.hpp"

namespace psygen::models {
namespace {

using network::Kind;
using network::Node;
using river_tests::kFrame;
using river_tests::network_of;

// Land of a seed: squares of 8 km whose middle is no sea.
std::vector<std::array<std::int64_t, 2>> land_places(const RiverSettings& settings,
                                                     std::size_t count) {
  const network::Scale scale(settings, kFrame);
  network::LandFields fields(scale);
  core::RandomStream random(settings.seed, 0, 0, 0, core::Purpose::kPosition);
  std::vector<std::array<std::int64_t, 2>> places;
  while (places.size() < count) {
    const std::int64_t x = random.next_integer(-2'000'000, 2'000'000);
    const std::int64_t z = random.next_integer(-2'000'000, 2'000'000);
    if (fields.continent(x * network::kUnitsPerCell, z * network::kUnitsPerCell) > 0.1)
      places.push_back({x, z});
  }
  return places;
}

TEST(RiverSettings, OutOfRangeAreRejectedWithTheirRange) {
  EXPECT_TRUE(check({}, kFrame).has_value());
  const auto message = [](const RiverSettings& settings, const RiverFrame& frame) {
    const auto result = check(settings, frame);
    EXPECT_FALSE(result.has_value());
    return result.has_value() ? std::string() : result.error().message;
  };
  EXPECT_EQ(message({.halvings = 9}, kFrame), "rivers: halvings is 9, but must lie in 1 … 8");
  EXPECT_EQ(message({.lake_share = std::nan("")}, kFrame),
            "rivers: lake_share is nan, but must lie in 0 … 0.12");
  EXPECT_NE(message({.root_spacing_m = 1000}, kFrame).find("finest nodes 7.81 cells apart"),
            std::string::npos);
  RiverFrame dry = kFrame;
  dry.sea_level_m = 0;
  EXPECT_NE(message({}, dry).find("the water level is 0 m"), std::string::npos);
  EXPECT_NE(identity({}, kFrame), identity({.seed = 2}, kFrame));
  EXPECT_NE(identity({}, kFrame), identity({.lake_share = 0.05}, kFrame));
  EXPECT_NE(identity({}, kFrame), identity({}, dry));
}

TEST(RiverRoot, HasTheSameWaysForEveryBorder) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    for (const double sea : {0.0, 0.35, 1.0}) {
      RiverSettings settings;
      settings.seed = seed;
      settings.sea_share = sea;
      const network::Scale scale(settings, kFrame);
      for (const std::int64_t at : {std::int64_t{0}, std::int64_t{-7}, std::int64_t{1} << 22}) {
        const network::TileKey key{0, at, at / 3};
        const network::RootTile tile = network::make_root_tile(scale, key);
        for (const std::int64_t border : {31, 47, 90}) {
          const network::RootTile other = network::make_root_tile(scale, key, border);
          for (std::size_t k = 0; k < tile.ways.size(); ++k) {
            ASSERT_EQ(tile.ways[k].receiver, other.ways[k].receiver);
            ASSERT_EQ(tile.ways[k].sea, other.ways[k].sea);
          }
        }
      }
    }
  }
}

// Counts of what must not be.
struct Faults {
  std::int64_t folds = 0, rises = 0, flats = 0, shrinking = 0, ends = 0, cycles = 0, long_edges = 0;
  std::int64_t land = 0, lakes = 0, sea = 0;
};

void count(const test::Drainage& n, const network::Scale& scale, Faults& faults) {
  const auto turn = [](const Node& a, const Node& b, const Node& c) {
    return static_cast<double>(b.x - a.x) * static_cast<double>(c.z - a.z) -
           static_cast<double>(b.z - a.z) * static_cast<double>(c.x - a.x);
  };
  const double longest = network::kLongestEdge * static_cast<double>(scale.spacing(n.p.level)) + 2;
  for (std::int64_t j = n.p.rect.j0; j + 1 < n.p.rect.j1; ++j) {
    for (std::int64_t i = n.p.rect.i0; i + 1 < n.p.rect.i1; ++i) {
      const Node &a = n.p.at(i, j), &b = n.p.at(i + 1, j), &c = n.p.at(i, j + 1),
                 &d = n.p.at(i + 1, j + 1);
      faults.folds += (turn(a, b, c) <= 0 ? 1 : 0) + (turn(b, d, c) <= 0 ? 1 : 0);
      faults.long_edges += distance(a, b) > longest || distance(a, c) > longest ? 1 : 0;
    }
  }
  faults.cycles += static_cast<std::int64_t>(n.size() - n.order.size());
  for (std::size_t q = 0; q < n.size(); ++q) {
    const Node& a = n.p.nodes[q];
    (a.kind == Kind::kLand ? faults.land : a.kind == Kind::kLake ? faults.lakes : faults.sea) += 1;
    if (a.kind == Kind::kSea) continue;
    if (n.to[q] < 0) {
      faults.ends += a.receiver == network::kSink && a.kind == Kind::kLand ? 1 : 0;
      continue;
    }
    const Node& b = n.p.nodes[static_cast<std::size_t>(n.to[q])];
    faults.rises += b.height > a.height ? 1 : 0;
    faults.flats += b.height == a.height && a.kind == Kind::kLand && b.kind == Kind::kLand ? 1 : 0;
    faults.shrinking += b.kind == Kind::kLand && b.area < a.area ? 1 : 0;
  }
}

TEST(RiverNodes, NeverFoldRiseShrinkCircleOrEndOnLand) {
  std::vector<RiverSettings> all;
  all.push_back({});
  all.push_back({.seed = 5, .lake_share = 0.12, .mountain_share = 0.9});
  all.push_back({.seed = 6, .root_spacing_m = 2048, .halvings = 6, .sea_share = 0});
  all.push_back({.seed = 7, .root_spacing_m = 1024, .halvings = 5, .steepness = 3});
  for (const RiverSettings& settings : all) {
    const auto network = network_of(settings);
    const network::Scale scale(settings, kFrame);
    Faults faults;
    for (const auto& [x, z] : land_places(settings, 4)) {
      for (const int level : {settings.halvings - 2, settings.halvings}) {
        const std::int64_t side = level == settings.halvings ? 8000 : 40000;
        count({network->nodes(level, x, z, side), scale.unit_m, 1}, scale, faults);
      }
    }
    EXPECT_GT(faults.land, 100'000);
    EXPECT_GT(faults.lakes, 500);
    EXPECT_EQ(faults.folds, 0);
    EXPECT_EQ(faults.long_edges, 0);
    EXPECT_EQ(faults.rises, 0);
    EXPECT_EQ(faults.flats, 0);
    EXPECT_EQ(faults.shrinking, 0);
    EXPECT_EQ(faults.ends, 0);
    EXPECT_EQ(faults.cycles, 0);
  }
}

TEST(RiverNodes, OfRiversEndInALakeOrTheSea) {
  // Follows rivers from random places through as many rectangles as they cross.
  const RiverSettings settings{.seed = 3};
  const auto network = network_of(settings);
  core::RandomStream random(9, 0, 0, 0, core::Purpose::kPosition);
  std::int64_t ends = 0, steps = 0;
  for (const auto& [x0, z0] : land_places(settings, 6)) {
    constexpr int kLevel = 4;
    constexpr std::int64_t kSide = 60'000;
    std::int64_t x = x0, z = z0;
    auto nodes = std::make_unique<network::NodePatch>(network->nodes(kLevel, x, z, kSide));
    const network::Rect inner = nodes->rect.grown(-2);
    std::int64_t i = random.next_integer(inner.i0, inner.i1 - 1);
    std::int64_t j = random.next_integer(inner.j0, inner.j1 - 1);
    for (int step = 0; step < 100'000; ++step, ++steps) {
      const Node n = nodes->at(i, j);
      if (n.kind == Kind::kSea || n.receiver == network::kSink) {
        EXPECT_NE(n.kind, Kind::kLand);
        ++ends;
        break;
      }
      i += network::kStepI[n.receiver];
      j += network::kStepJ[n.receiver];
      const network::Rect r = nodes->rect.grown(-1);
      if (i >= r.i0 && j >= r.j0 && i < r.i1 && j < r.j1) continue;
      x = nodes->at(i, j).x / network::kUnitsPerCell - kSide / 2;
      z = nodes->at(i, j).z / network::kUnitsPerCell - kSide / 2;
      nodes = std::make_unique<network::NodePatch>(network->nodes(kLevel, x, z, kSide));
    }
  }
  EXPECT_EQ(ends, 6);
  EXPECT_GT(steps, 300);
}

TEST(RiverNodes, HaveTheStatisticsOfRealRivers) {
  // Ranges: Kirchner (1993) and Abrahams (1984) for the ratios, Hack (1957) and Dodds & Rothman
  // (2000) for the exponent, Gailleton et al. (2021) for concavity.
  const RiverSettings settings{.seed = 1, .sea_share = 0.2};
  const network::Scale scale(settings, kFrame);
  const auto network = network_of(settings);
  constexpr int kLevel = 5;
  const double node_km2 = scale.node_km2 * 16;
  const auto place = land_places(settings, 1).front();
  const test::Drainage n(network->nodes(kLevel, place[0], place[1], 180'000), scale.unit_m,
                         node_km2);
  const test::RiverStatistics s = test::statistics_of(n, 1);
  RecordProperty("statistics",
                 testing::PrintToString(std::vector{s.bifurcation, s.length_ratio, s.area_ratio,
                                                    s.hack, s.concavity, s.sinuosity}));
  EXPECT_GT(s.bifurcation, 3);
  EXPECT_LT(s.bifurcation, 5.5);
  EXPECT_GT(s.length_ratio, 1.5);
  EXPECT_LT(s.length_ratio, 3.5);
  EXPECT_GT(s.area_ratio, 3);
  EXPECT_LT(s.area_ratio, 6);
  EXPECT_GT(s.hack, 0.5);
  EXPECT_LT(s.hack, 0.7);
  EXPECT_GT(s.concavity, 0.225);
  EXPECT_LT(s.concavity, 0.575);
  EXPECT_GT(s.sinuosity, 1.05);
}

}  // namespace
}  // namespace psygen::models
