// Rules for places: each instance obeys them, and those that obey them stand.

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "engine/world/curve.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/spacing.hpp"
#include "engine/world/water.hpp"
#include "engine/world/world_parts.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using testing::parsed;
using testing::registry;

constexpr std::uint32_t kOaks = 30, kBushes = 200;

// Oaks 8 m apart, and bushes with some rules, on land with a shore and a road.
std::string land(std::string_view of_bushes) {
  return R"(format = 1
[world]
name = "site"
seed = 5
blocks = [32, 32]
block_vertices = 65
cell_m = 1
[terrain]
relief_m = 160
feature_m = 300
[water]
level_m = 60
[[road]]
points_m = [[80, 200], [400, 330], [700, 300]]
[[scatter]]
model = "tree"
count = 30
spacing_m = 8
min_height_m = 50
[[scatter]]
model = "rock"
count = 200
radius_m = [0.2, 1.2]
spacing_m = 0.001
)" + std::string(of_bushes);
}

// The bushes of some blocks, by block and index.
using Stands = std::map<std::pair<int, std::uint32_t>, Placement>;
constexpr int kSide = 6;
core::BlockCoord block_at(int i) {
  return {1 + i % kSide, 1 + i / kSide};
}
Stands bushes_of(const World& world) {
  Stands all;
  std::vector<Placement> placed;
  for (int i = 0; i < kSide * kSide; ++i) {
    place_models(world, registry(), block_at(i), placed);
    for (const Placement& p : placed)
      if (p.index >= kOaks) all.emplace(std::pair(i, p.index), p);
  }
  return all;
}

// Compares the bushes with `rules` to those of the same land without that fulfil `obeys(block,
// placement)`. They are the same ones: each tries one place, which no other bush takes.
template <class Obeys>
void expect_those_that(std::string_view rules, const Obeys& obeys) {
  const Stands all = bushes_of(parsed(land(""))), some = bushes_of(parsed(land(rules)));
  std::size_t expected = 0;
  for (const auto& [key, bush] : all) {
    const bool should = obeys(block_at(key.first), bush);
    expected += should ? 1 : 0;
    EXPECT_EQ(some.contains(key), should) << key.first << " " << key.second;
  }
  EXPECT_EQ(some.size(), expected);
  EXPECT_GT(expected, all.size() / 50);
  EXPECT_LT(expected, all.size());
}

// The angle between the ground and the horizontal, and between its fall and `facing_deg`.
glm::dvec2 slope_of(const World& world, core::BlockCoord block, const Placement& p,
                    double facing_deg) {
  const glm::vec3 n =
      models::BlockGround(world.terrain, block, 1).at({p.position.x, p.position.z}).normal;
  const double azimuth = std::atan2(double{n.x}, -double{n.z}) * 180 / std::numbers::pi;
  const double away = azimuth - facing_deg;
  return {std::acos(double{n.y}) * 180 / std::numbers::pi,
          std::abs(away - 360 * std::round(away / 360))};
}

TEST(SiteRules, SteepGroundThatFacesNorth) {
  const World world = parsed(land(""));
  expect_those_that("min_slope_deg = 15\nfacing_deg = 350\nfacing_spread_deg = 60\n",
                    [&](core::BlockCoord block, const Placement& p) {
                      const glm::dvec2 slope = slope_of(world, block, p, 350);
                      return slope.x >= 15 && slope.y <= 60;
                    });
}

TEST(SiteRules, FlatGroundFacesEverywhere) {
  const World world = parsed(land(""));
  expect_those_that("facing_deg = 100\nfacing_spread_deg = 20\n",
                    [&](core::BlockCoord block, const Placement& p) {
                      const glm::dvec2 slope = slope_of(world, block, p, 100);
                      return slope.x < SiteRules::kFlatDeg || slope.y <= 20;
                    });
}

// The distance to the sea, in steps of half a metre.
double to_sea_m(const World& world, core::BlockCoord block, const Placement& p, double limit_m) {
  const models::BlockGround ground(world.terrain, block, 100'000);
  for (double away = 0; away <= limit_m; away += 0.5) {
    for (int k = 0; k < 48; ++k) {
      const double angle = k * std::numbers::pi / 24;
      if (ground.at({p.position.x + away * std::cos(angle), p.position.z + away * std::sin(angle)})
              .height_m < world.water.level_m)
        return away;
    }
  }
  return 2 * limit_m;
}

// The rule looks at two rings of places, so it may miss a creek.
TEST(SiteRules, DistanceAndHeightAboveWater) {
  const World world = parsed(land(""));
  std::size_t wet = 0, dry = 0, high = 0, missed = 0;
  for (const auto& [key, bush] : bushes_of(parsed(land("far_from_water_m = 10\n")))) {
    ++dry;
    missed += to_sea_m(world, block_at(key.first), bush, 10) < 9.5 ? 1 : 0;
  }
  for (const auto& [key, bush] : bushes_of(parsed(land("near_water_m = 16\n"))))
    high += bush.position.y > world.water.level_m + 3 ? 1 : 0;
  for (const auto& [key, bush] :
       bushes_of(parsed(land("near_water_m = 16\nmax_above_water_m = 3\nmax_depth_m = 0\n")))) {
    ++wet;
    EXPECT_LE(to_sea_m(world, block_at(key.first), bush, 16), 16.5);
    EXPECT_LE(bush.position.y, world.water.level_m + 3);
    EXPECT_GE(bush.position.y, world.water.level_m);
  }
  EXPECT_GT(dry, 2000U);
  EXPECT_LT(missed, dry / 100);
  EXPECT_GT(wet, 50U);
  EXPECT_GT(high, 50U);
}

TEST(SiteRules, DistanceToRoads) {
  const World world = parsed(land(""));
  // The middle of the road in steps of 10 cm.
  const std::vector<CurvePoint> corners = curve_through(world.shaped.roads[0].points_m, 0.1);
  const double half_m = world.shaped.roads[0].width_m / 2;
  expect_those_that("far_from_road_m = 4\nnear_road_m = 40\n",
                    [&](core::BlockCoord block, const Placement& p) {
                      double nearest = 1e9;
                      for (const CurvePoint& at : corners) {
                        const glm::dvec2 away = glm::dvec2(block.x, block.z) * 64.0 +
                                                glm::dvec2(p.position.x, p.position.z) - at.at_m;
                        nearest = std::min(nearest, std::hypot(away.x, away.y));
                      }
                      return nearest - half_m >= 4 && nearest - half_m <= 40;
                    });
}

TEST(SiteRules, BesideAnotherAcrossBorders) {
  const World world = parsed(land(""));
  std::vector<glm::dvec2> oaks;
  std::vector<Placement> placed;
  for (int i = 0; i < (kSide + 2) * (kSide + 2); ++i) {
    const core::BlockCoord block{i % (kSide + 2), i / (kSide + 2)};
    place_models(world, registry(), block, placed);
    for (const Placement& p : placed)
      if (p.index < kOaks)
        oaks.push_back(glm::dvec2(block.x, block.z) * 64.0 +
                       glm::dvec2(p.position.x, p.position.z));
  }
  const auto is_beside = [&](core::BlockCoord block, const Placement& p) {
    return std::ranges::any_of(oaks, [&](const glm::dvec2& oak) {
      const glm::dvec2 away =
          glm::dvec2(block.x, block.z) * 64.0 + glm::dvec2(p.position.x, p.position.z) - oak;
      return std::hypot(away.x, away.y) < 6;
    });
  };
  expect_those_that("beside = \"tree\"\nbeside_m = 6\n", is_beside);
}

// Without a spacing an instance tries several places.
TEST(SiteRules, BesideAnotherWithoutASpacing) {
  const std::string free = testing::replaced(land(""), "spacing_m = 0.001\n", "");
  const auto there = bushes_of(parsed(free + "beside = \"tree\"\nbeside_m = 6\n"));
  EXPECT_GT(there.size(), bushes_of(parsed(free)).size() / 2);
  EXPECT_GT(there.size(), 3 * bushes_of(parsed(land("beside = \"tree\"\nbeside_m = 6\n"))).size());
}

TEST(SiteRules, PatchesFadeAndTheirBordersHaveSmallInstances) {
  const std::string patches = "mask_noise_m = 40\nmask_share = 0.4\nmask_fade = 0.8\n";
  const World world = parsed(land(patches + "edge_size = 0.25\n"));
  const ScatterMask& mask = world.scatter[1].mask;
  const Stands all = bushes_of(parsed(land(""))), some = bushes_of(world);
  const auto radius = static_cast<std::size_t>(
      models::parameter_index(registry()[world.scatter[1].model], "radius_m"));
  std::array<double, 4> kept{}, tried{};
  for (const auto& [key, bush] : all) {
    const core::BlockCoord block = block_at(key.first);
    const double share = mask_share(
        mask, world.seed,
        glm::dvec2(block.x, block.z) * 64.0 + glm::dvec2(bush.position.x, bush.position.z));
    const auto quarter = static_cast<std::size_t>(std::min(share * 4, 3.0));
    ++tried[quarter];
    const auto found = some.find(key);
    if (found == some.end()) continue;
    ++kept[quarter];
    const double part = 0.25 + 0.75 * share;  // of the range in metres
    EXPECT_NEAR(found->second.parameters.real(radius),
                0.2 + part * (bush.parameters.real(radius) - 0.2), 1e-9);
  }
  EXPECT_NEAR(static_cast<double>(some.size()) / static_cast<double>(all.size()), 0.4, 0.06);
  for (std::size_t i = 0; i + 1 < kept.size(); ++i) {
    EXPECT_GT(tried[i], 100);
    EXPECT_LT(kept[i] / tried[i], kept[i + 1] / tried[i + 1]);
  }
}

// Bushes beside bushes beside oaks: a chain costs no more than its blocks.
TEST(SiteRules, ChainsStandBesideEachOther) {
  const std::string link = "[[scatter]]\nmodel = \"rock\"\ncount = 40\nspacing_m = 0.001\n";
  std::string text = land("beside = \"tree\"\nbeside_m = 12\n");
  for (int i = 0; i < 4; ++i)
    text += link + "beside = \"rock\"\nbeside_m = 9\n";
  const World world = parsed(text);
  EXPECT_EQ(world.scatter[5].site.beside, 0b11110U);
  const Stands all = bushes_of(world);
  // Each stands beside one of an earlier table, which may be on the next block.
  const auto place_m = [](int block, const Placement& p) {
    return glm::dvec2(block_at(block).x, block_at(block).z) * 64.0 +
           glm::dvec2(p.position.x, p.position.z);
  };
  std::size_t links = 0;
  for (const auto& [key, stone] : all) {
    if (stone.index < kOaks + kBushes) continue;
    const glm::dvec2 at_m = place_m(key.first, stone), in_all = at_m - 64.0;
    if (std::min(in_all.x, in_all.y) < 9 || std::max(in_all.x, in_all.y) > kSide * 64 - 9) continue;
    ++links;
    const std::uint32_t first = stone.index - (stone.index - kOaks - kBushes) % 40;  // of its table
    EXPECT_TRUE(std::ranges::any_of(all, [&](const auto& other) {
      const glm::dvec2 away = place_m(other.first.first, other.second) - at_m;
      return other.second.index < first && std::hypot(away.x, away.y) < 9;
    })) << stone.index;
  }
  EXPECT_GT(links, 100U);
}

// A world without the rule draws exactly what it drew before there was one. The sum of 0.09 and
// 0.34 - 0.09 is not 0.34.
TEST(SiteRules, WithoutAnEdgeSizesAreTheNumbersOfTheStream) {
  const World world = parsed(testing::replaced(land(""), "[0.2, 1.2]", "[0.09, 0.34]"));
  const models::ModelType& type = registry()[world.scatter[1].model];
  const auto radius = static_cast<std::size_t>(models::parameter_index(type, "radius_m"));
  std::size_t drawn_before = 0;
  for (std::size_t i = 0; i < radius; ++i)
    drawn_before += type.parameters()[i].source == models::ParameterSource::kUser ? 1 : 0;
  for (const auto& [key, stone] : bushes_of(world)) {
    const core::BlockCoord block = block_at(key.first);
    core::RandomStream values(world.seed, block.x, block.z, stone.index,
                              core::Purpose::kParameters);
    for (std::size_t i = 0; i < drawn_before; ++i)
      values.next_u64();
    ASSERT_EQ(stone.parameters.real(radius), std::min(values.next_real(0.09, 0.34), 0.34));
  }
}

TEST(SiteRules, AreWrittenAndTellTheTablesThatTheyConcern) {
  const std::string rules =
      "min_slope_deg = 2\nmax_slope_deg = 50\nfacing_deg = 90\nfacing_spread_deg = 120\n"
      "near_water_m = 40\nmax_above_water_m = 30\nfar_from_water_m = 5\nnear_road_m = 200\n"
      "far_from_road_m = 3\nbeside = \"tree\"\nbeside_m = 20\nmask_noise_m = 30\n"
      "mask_fade = 0.5\nedge_size = 0.5\n";
  const World world = parsed(land(rules)), none = parsed(land(""));
  EXPECT_EQ(parsed(write_world(world, registry())), world);
  EXPECT_EQ(site_hash(none.scatter[1].site), 0U);
  const WorldParts parts = parts_of(world, registry());
  using Change = std::pair<const char*, const char*>;
  for (const auto& [rule, other] : {Change{"min_slope_deg = 2", "min_slope_deg = 3"},
                                    {"facing_deg = 90", "facing_deg = 80"},
                                    {"facing_spread_deg = 120", "facing_spread_deg = 110"},
                                    {"max_above_water_m = 30", "max_above_water_m = 31"},
                                    {"far_from_water_m = 5", "far_from_water_m = 6"},
                                    {"near_road_m = 200", "near_road_m = 100"},
                                    {"far_from_road_m = 3", "far_from_road_m = 4"},
                                    {"beside_m = 20", "beside_m = 15"},
                                    {"mask_fade = 0.5", "mask_fade = 0.4"}}) {
    const World changed = parsed(testing::replaced(land(rules), rule, other));
    EXPECT_NE(parts_of(changed, registry()).places[1], parts.places[1]) << rule;
    EXPECT_NE(merged_identity(changed, registry()), merged_identity(world, registry())) << rule;
  }
  const World small = parsed(testing::replaced(land(rules), "edge_size = 0.5", "edge_size = 0.4"));
  EXPECT_EQ(parts_of(small, registry()).places, parts.places);
  EXPECT_NE(parts_of(small, registry()).models[1], parts.models[1]);
  EXPECT_NE(merged_identity(small, registry()), merged_identity(world, registry()));
}

TEST(SiteRules, ThatContradictEachOtherAreRefused) {
  const auto problem = [](std::string_view rules) {
    const auto world = parse_world(land(rules), "site.toml", registry());
    return world ? std::string() : world.error().message;
  };
  const auto expect = [&](std::string_view rules, std::string_view part) {
    EXPECT_NE(problem(rules).find(part), std::string::npos) << rules << problem(rules);
  };
  expect("min_slope_deg = 30\nmax_slope_deg = 20\n", "must not be above max_slope_deg");
  expect("max_above_water_m = 3\n", "it needs near_water_m");
  expect("near_road_m = 3\nfar_from_road_m = 3\n", "must be above far_from_road_m");
  expect("edge_size = 0.5\n", "it needs a mask and spacing_m");
  expect("beside_m = 3\n", "which is missing");
  EXPECT_EQ(parsed(land("beside = \"tree\"\n")).scatter[1].site.beside_m, (8 + 0.001) / 2 + 5);
  expect("near_water_m = 3\nfar_from_water_m = 3\n", "must be above far_from_water_m");
  expect("beside = \"grass\"\nbeside_m = 3\n", "no earlier [[scatter]]");
  expect("beside = \"heron\"\nbeside_m = 3\n", "no earlier [[scatter]]");
  expect("beside = \"tree\"\nbeside_m = 3\n", "must be above 4");
  expect("beside = \"tree\"\nbeside_m = 300\n", "4 sides of a block");
  expect("facing_spread_deg = 200\n", "facing_spread_deg");
  const std::string many = testing::replaced(
      testing::replaced(land("beside = \"tree\"\nbeside_m = 60\n"), "spacing_m = 0.001\n", ""),
      "count = 200", "count = 3000");
  const auto slow = parse_world(many, "site.toml", registry());
  ASSERT_FALSE(slow);
  EXPECT_NE(slow.error().message.find("the tables with beside try 72000 places"), std::string::npos)
      << slow.error().message;
  EXPECT_EQ(problem("min_slope_deg = 20\nmax_slope_deg = 20\n"), "");
  const std::string wide = testing::replaced(land("beside = \"tree\"\nbeside_m = 30\n"),
                                             "spacing_m = 0.001", "spacing_m = 9");
  const auto refused = parse_world(wide, "site.toml", registry());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("spacing_m must be at most 8 m"), std::string::npos);
}

// The room of a mesh is a share of all that try.
TEST(SiteRules, MergedMeshesHaveRoomForWhatStands) {
  const auto text = [](const char* count, const char* spacing_m) {
    std::string bare = testing::replaced(land(""), "count = 200", "count = 0");
    bare = testing::replaced(bare, "min_height_m = 50\n", "");
    return testing::replaced(bare, "count = 30\nspacing_m = 8",
                             std::string("count = ") + count + "\nspacing_m = " + spacing_m);
  };
  const auto size_of = [](const World& world) {
    const auto type = make_merged_type(std::make_shared<const World>(world), registry());
    return static_cast<double>(type->mesh_size(merged_parameters({1, 1}, 3), 0).vertex_count);
  };
  for (const char* count : {"5", "120"}) {
    const double free = size_of(parsed(text(count, "0")));
    for (const char* spacing_m : {"0.0001", "0.001", "0.05", "1", "4", "30"}) {
      const World apart = parsed(text(count, spacing_m));
      std::vector<Placement> placed;
      double standing = 0;
      for (int i = 0; i < 64; ++i) {
        place_models(apart, registry(), {8 + i % 8, 8 + i / 8}, placed);
        standing += static_cast<double>(placed.size());
      }
      const double room = size_of(apart) / free;
      EXPECT_LE(room, 1);
      EXPECT_GE(room * 64 * std::stod(count), standing) << count << " " << spacing_m;
    }
  }
  EXPECT_LT(size_of(parsed(text("120", "4"))), 0.7 * size_of(parsed(text("120", "0"))));
}

TEST(SiteRules, TheShareThatStandsIsExactForAllSpacings) {
  EXPECT_EQ(kept_share(1, 0), 1);
  for (double spacing_m = 1e-6; spacing_m < 300; spacing_m *= 1.3) {
    for (const double count : {1.0, 20.0, 16384.0}) {
      const double within = count / 4096 * std::numbers::pi * spacing_m * spacing_m;
      const double share = kept_share(count / 4096, spacing_m);
      EXPECT_NEAR(share, -std::expm1(-within) / within, 1e-5);
      EXPECT_GT(share, 0);
      EXPECT_LE(share, 1);
    }
  }
}

}  // namespace
}  // namespace psygen::world
