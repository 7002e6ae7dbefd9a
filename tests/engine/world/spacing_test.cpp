#include "engine/world/spacing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/world/edits/edits.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/far/node_walk.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/world_parts.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using testing::parsed;
using testing::registry;

// Trees 5 m apart and rocks 3 m, on land of 64 × 64 m blocks.
std::string wood(std::string_view of_trees = "spacing_m = 5",
                 std::string_view of_rocks = "spacing_m = 3") {
  return R"(format = 1
[world]
name = "wood"
seed = 11
blocks = [0, 0]
block_vertices = 65
cell_m = 1
[terrain]
relief_m = 160
feature_m = 300
[[scatter]]
model = "tree"
count = 90
)" + std::string(of_trees) +
         "\n[[scatter]]\nmodel = \"rock\"\ncount = 60\n" + std::string(of_rocks) + "\n";
}

std::vector<Placement> standing(const World& world, core::BlockCoord block) {
  std::vector<Placement> out;
  place_models(world, registry(), block, out);
  return out;
}

// The instances of some blocks, in metres of the world.
struct Stand {
  glm::dvec2 at_m;
  double spacing_m;
};
std::vector<Stand> stands(const World& world, core::BlockCoord first, int side) {
  std::vector<Stand> all;
  for (int z = 0; z < side; ++z) {
    for (int x = 0; x < side; ++x) {
      for (const Placement& p : standing(world, {first.x + x, first.z + z})) {
        std::size_t s = 0;
        for (std::uint32_t end = world.scatter[0].count; p.index >= end;)
          end += world.scatter[++s].count;
        if (!world.scatter[s].keeps_apart()) continue;
        all.push_back(
            {glm::dvec2(x, z) * world.block_size_m() + glm::dvec2(p.position.x, p.position.z),
             world.scatter[s].spacing_m});
      }
    }
  }
  return all;
}

TEST(Spacing, NoTwoDiscsOverlapAcrossBlocks) {
  const auto expect_apart = [](const std::vector<Stand>& all) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const glm::dvec2 away = all[i].at_m - all[j].at_m;
        ASSERT_GE(std::hypot(away.x, away.y), (all[i].spacing_m + all[j].spacing_m) / 2);
      }
    }
  };
  for (const char* of_trees :
       {"spacing_m = 5", "spacing_m = 90", "spacing_m = 5\nmax_slope_deg = 20"}) {
    const World world = parsed(wood(of_trees));
    for (const core::BlockCoord first : {core::BlockCoord{-3, -3}, core::BlockCoord{7000, -81}}) {
      const std::vector<Stand> all = stands(world, first, 6);
      EXPECT_GT(all.size(), 4U);
      expect_apart(all);
    }
  }
}

// Places of trees and rocks with their radii at the ground.
struct Stem {
  glm::dvec2 at_m;
  double radius_m;
  bool is_rock;
};

// Sorts stems into squares of this side and compares those of neighbouring squares.
std::size_t overlaps_of(const std::vector<Stem>& all, double side_m) {
  std::map<std::pair<int, int>, std::vector<const Stem*>> squares;
  std::size_t overlaps = 0;
  for (const Stem& stem : all) {
    const int x = static_cast<int>(std::floor(stem.at_m.x / side_m));
    const int z = static_cast<int>(std::floor(stem.at_m.y / side_m));
    for (int k = 0; k < 9; ++k) {
      const auto square = squares.find({x + k % 3 - 1, z + k / 3 - 1});
      if (square == squares.end()) continue;
      for (const Stem* other : square->second) {
        const glm::dvec2 away = stem.at_m - other->at_m;
        const bool both_rocks = stem.is_rock && other->is_rock;
        overlaps += !both_rocks && std::hypot(away.x, away.y) < stem.radius_m + other->radius_m;
      }
    }
    squares[{x, z}].push_back(&stem);
  }
  return overlaps;
}

// The stems of side * side blocks.
std::vector<Stem> stems_of(const World& world, const models::Registry& types, int side) {
  std::vector<Stem> all;
  std::vector<Placement> placed;
  for (int i = 0; i < side * side; ++i) {
    const core::BlockCoord block{30 + i % side, 30 + i / side};
    place_models(world, types, block, placed);
    for (const Placement& p : placed) {
      const models::ModelType& type = types[p.model];
      if (type.name() == "grass") continue;
      const auto radius = static_cast<std::size_t>(models::parameter_index(type, "radius_m"));
      all.push_back({glm::dvec2(block.x, block.z) * world.block_size_m() +
                         glm::dvec2(p.position.x, p.position.z),
                     p.parameters.real(radius), type.name() == "rock"});
    }
  }
  return all;
}

// The worlds of the paper are as the paper has them.
TEST(Spacing, NoTrunkOfAShippedWorldStandsInAnotherOrInARock) {
  for (const auto& [name, text] : testing::shipped_worlds()) {
    models::Registry types = models::make_standard_registry();
    const auto world = parse_world(text, name, types);
    ASSERT_TRUE(world) << world.error().message;
    const std::vector<Stem> all = stems_of(*world, types, 12);
    if (name == "paper.toml" || name == "endless.toml") {
      EXPECT_GT(overlaps_of(all, 8), 0U) << name;
      continue;
    }
    EXPECT_GT(all.size(), 500U) << name;
    EXPECT_EQ(overlaps_of(all, 8), 0U) << name;
  }
}

// Thinning by random priorities keeps (1 - e^-n) / n of n candidates within the spacing.
TEST(Spacing, KeepsTheShareThatTheFormulaSays) {
  for (const double spacing_m : {2.0, 3.0, 6.0}) {
    const World world = parsed(wood("spacing_m = " + std::to_string(spacing_m), ""));
    double kept = 0;
    constexpr int kBlocksASide = 16;
    for (int z = 0; z < kBlocksASide; ++z) {
      for (int x = 0; x < kBlocksASide; ++x) {
        for (const Placement& p : standing(world, {x, z}))
          kept += p.index < 90 ? 1 : 0;
      }
    }
    const double within = 90 * 3.14159265 * spacing_m * spacing_m / (64 * 64);
    EXPECT_NEAR(kept / (90 * kBlocksASide * kBlocksASide), (1 - std::exp(-within)) / within, 0.01);
  }
}

TEST(Spacing, IsTheSameForSomeScattersAsForAll) {
  const World world = parsed(wood());
  for (int x = 0; x < 8; ++x) {
    const std::vector<Placement> all = standing(world, {x, 3});
    for (const std::size_t s : {std::size_t{0}, std::size_t{1}}) {
      std::vector<Placement> some;
      std::vector<bool> wanted(2, false);
      wanted[s] = true;
      place_models(world, registry(), {x, 3}, wanted, some);
      std::vector<std::uint32_t> expected, seen;
      for (const Placement& p : all)
        if ((p.index < 90) == (s == 0)) expected.push_back(p.index);
      for (const Placement& p : some)
        seen.push_back(p.index);
      EXPECT_EQ(seen, expected);
    }
  }
}

TEST(Spacing, InstancesThatStandNowhereClearNothing) {
  const World with = parsed(wood("spacing_m = 9\nmin_height_m = 9000")), alone = parsed(wood(""));
  for (int x = 0; x < 4; ++x) {
    std::vector<std::uint32_t> rocks, expected;
    for (const Placement& p : standing(with, {x, 0}))
      rocks.push_back(p.index);
    for (const Placement& p : standing(alone, {x, 0}))
      if (p.index >= 90) expected.push_back(p.index);
    EXPECT_EQ(rocks, expected);
  }
}

TEST(Spacing, AFelledTreePlantsNoOther) {
  World world = parsed(wood());
  const std::vector<Placement> before = standing(world, {2, 2});
  Edits edits;
  for (std::size_t i = 0; i < before.size(); i += 2)
    ASSERT_TRUE(edits.remove(world, {{2, 2}, before[i].index}));
  set_edits(world, edits.layer());
  const std::vector<Placement> after = standing(world, {2, 2});
  ASSERT_EQ(after.size(), before.size() / 2);
  for (std::size_t i = 0; i < after.size(); ++i)
    EXPECT_EQ(after[i].index, before[2 * i + 1].index);
}

// Instances of nodes that differ in standing from those of blocks, of so many.
struct Difference {
  std::size_t differ = 0, near = 0;
};
Difference difference_of(const World& world, int level, bool shares = false) {
  SpacedBlocks shared(world);
  const NodeWalk walk(world, {0, 0}, level);
  std::optional<models::BlockGround> ground;
  Difference sum;
  for (std::uint32_t i = 0; i < walk.block_count(); ++i) {
    if (walk.starts_tile(i)) walk.make_ground(i, 10'000, ground);
    const NodeBlock block = walk.block(i);
    std::map<std::uint32_t, glm::vec3> near;
    for (const Placement& p : standing(world, block.coord))
      near[p.index] = p.position;
    BlockObstacles obstacles(world, block.coord, shares ? &shared : nullptr);
    for (std::uint32_t s = 0, first = 0; s < 2; first += world.scatter[s++].count) {
      const Scatter& scatter = world.scatter[s];
      const Scattering far(world, registry()[scatter.model], scatter, obstacles);
      for (std::uint32_t index = first; index < first + scatter.count; ++index) {
        const auto place = far.place(*ground, index, block.in_tile_m);
        const auto known = near.find(index);
        sum.near += known != near.end() ? 1 : 0;
        sum.differ += place.has_value() != (known != near.end()) ? 1 : 0;
        if (!place || known == near.end()) continue;
        EXPECT_EQ(place->position.x, known->second.x);
        EXPECT_EQ(place->position.z, known->second.z);
      }
    }
  }
  return sum;
}

// Where heights are cheap, limits of the ground are those of the exact ground.
TEST(Spacing, StandsFarAsNear) {
  const World free = parsed(wood()), limited = parsed(wood("spacing_m = 5\nmax_slope_deg = 40")),
              warped = parsed(testing::replaced(wood("spacing_m = 5\nmax_slope_deg = 40"),
                                                "relief_m = 160", "relief_m = 160\nwarp = 0.3")),
              beside =
                  parsed(wood("spacing_m = 5", "spacing_m = 1\nbeside = \"tree\"\nbeside_m = 6"));
  for (const int level : {1, 2, 3, 4}) {
    const Difference in_free = difference_of(free, level),
                     in_limited = difference_of(limited, level);
    EXPECT_GT(in_free.near, 200U);
    EXPECT_EQ(in_free.differ, 0U);
    for (const World* each : {&free, &limited, &beside})
      EXPECT_EQ(difference_of(*each, level, true).differ, 0U);
    EXPECT_EQ(difference_of(beside, level).differ, 0U);
    EXPECT_GT(in_limited.near, 200U);
    EXPECT_EQ(in_limited.differ, 0U);
    const Difference in_warped = difference_of(warped, level);
    EXPECT_EQ(difference_of(warped, level, true).differ, in_warped.differ);
    EXPECT_LE(in_warped.differ, level <= 2 ? 0 : in_warped.near / 5);
  }
}

TEST(Footprint, StandsOnTheLowestGroundBelowIt) {
  const World world = parsed(wood("footprint_m = 8\nmax_slope_deg = 30", ""));
  const World middle = parsed(wood("max_slope_deg = 30", ""));
  std::size_t feet = 0, floating = 0, sunk = 0, floating_before = 0;
  for (int x = 0; x < 12; ++x) {
    const core::BlockCoord block{x, -5};
    const models::BlockGround ground(world.terrain, block, 10'000);
    const std::vector<Placement> now = standing(world, block), before = standing(middle, block);
    ASSERT_EQ(now.size(), before.size());
    for (std::size_t i = 0; i < now.size() && now[i].index < 90; ++i) {
      ++feet;
      EXPECT_EQ(now[i].position.x, before[i].position.x);
      float lowest = 1e9F, highest = -1e9F;
      for (int k = 0; k < 17 * 17; ++k) {
        const glm::dvec2 at(now[i].position.x + k % 17 / 2.0 - 4,
                            now[i].position.z + k / 17 / 2.0 - 4);
        const auto height_m = static_cast<float>(ground.at(at).height_m);
        lowest = std::min(lowest, height_m);
        highest = std::max(highest, height_m);
      }
      floating += now[i].position.y - lowest > 1e-4F ? 1 : 0;
      sunk += lowest - now[i].position.y > 0.2F ? 1 : 0;
      floating_before += before[i].position.y - lowest > 0.2F ? 1 : 0;
      EXPECT_LE(now[i].position.y, highest);
    }
  }
  EXPECT_GT(feet, 400U);
  EXPECT_GT(floating_before, feet / 2);
  EXPECT_EQ(floating, 0U);
  EXPECT_EQ(sunk, 0U);
}

TEST(Tilt, IsAShareOfTheSlope) {
  const auto meadow = [](const char* tilt) {
    return parsed(wood() + "[[scatter]]\nmodel = \"grass\"\ncount = 60\n" + tilt);
  };
  const World whole = meadow(""), half = meadow("tilt = 0.5"), upright = meadow("tilt = 0");
  const auto [x, z] = slope_parameters(registry()[whole.scatter[2].model]);
  ASSERT_GE(std::min(x, z), 0);
  const auto slopes = [&](const World& world) {
    std::vector<double> all;
    for (const Placement& p : standing(world, {1, 1})) {
      if (p.index < 150) continue;
      all.push_back(p.parameters.real(static_cast<std::size_t>(x)));
      all.push_back(p.parameters.real(static_cast<std::size_t>(z)));
    }
    return all;
  };
  const std::vector<double> a = slopes(whole), b = slopes(half), c = slopes(upright);
  ASSERT_EQ(a.size(), 120U);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(b[i], a[i] / 2, 1e-6);
    EXPECT_EQ(c[i], 0);
  }
  EXPECT_GT(*std::ranges::max_element(a), 0.1);
}

// Two blocks on both sides of the seam of an endless world, and the border of a bounded one.
TEST(Spacing, HoldsAtTheSeamAndInBoundedWorlds) {
  const World world = parsed(wood("spacing_m = 20"));
  const auto west = standing(world, {INT32_MAX, 4}), east = standing(world, {INT32_MIN, 4});
  ASSERT_FALSE(west.empty() || east.empty());
  for (const Placement& a : west) {
    for (const Placement& b : east) {
      if (a.index >= 90 || b.index >= 90) continue;
      EXPECT_GE(std::hypot(64 + b.position.x - a.position.x, b.position.z - a.position.z), 20);
    }
  }
  const World bounded = parsed(testing::replaced(wood(), "blocks = [0, 0]", "blocks = [1, 1]"));
  const std::size_t alone = standing(bounded, {0, 0}).size();
  EXPECT_GT(alone, standing(parsed(wood()), {0, 0}).size());
  EXPECT_FALSE(standing(bounded, {5, 0}).empty());  // which nobody draws
}

// An edit that does not reach a block changes nothing there, whoever asks first.
TEST(Spacing, FollowsNoEditBeyondTheBorder) {
  World world = parsed(wood("spacing_m = 5\nfootprint_m = 12\nmax_slope_deg = 40") +
                       "[water]\nlevel_m = 40\n[[scatter]]\nmodel = \"rock\"\ncount = 40\n"
                       "spacing_m = 4\nnear_water_m = 30\n");
  std::vector<std::vector<Placement>> before;
  for (int z = 0; z < 4; ++z)
    before.push_back(standing(world, {3, z}));
  Edits edits;
  for (int z = 0; z < 4; ++z) {
    core::WorldPosition at{{2, z}, {64 - 9, 0, 32}};
    ASSERT_TRUE(edits.raise(world, at, 6, -25));
  }
  set_edits(world, edits.layer());
  for (int z = 0; z < 4; ++z) {
    const auto after = standing(world, {3, z});
    ASSERT_EQ(after.size(), before[static_cast<std::size_t>(z)].size());
    for (std::size_t i = 0; i < after.size(); ++i) {
      const Placement& was = before[static_cast<std::size_t>(z)][i];
      EXPECT_EQ(after[i].index, was.index);
      EXPECT_EQ(after[i].position, was.position);
    }
  }
}

TEST(Spacing, IsWrittenAndTellsTheTablesThatItConcerns) {
  const World world = parsed(wood("spacing_m = 5\nfootprint_m = 3\ntilt = 0.25"));
  const World again = parsed(write_world(world, registry()));
  EXPECT_EQ(again.scatter, world.scatter);
  const World wider = parsed(wood("spacing_m = 5\nfootprint_m = 3\ntilt = 0.25", "spacing_m = 4"));
  const World tilted = parsed(wood("spacing_m = 5\nfootprint_m = 3\ntilt = 0.5"));
  const WorldParts parts = parts_of(world, registry());
  EXPECT_NE(parts_of(wider, registry()).places[0], parts.places[0]);
  EXPECT_EQ(parts_of(tilted, registry()).places, parts.places);
  EXPECT_NE(parts_of(tilted, registry()).models[0], parts.models[0]);
  EXPECT_NE(merged_identity(wider, registry()), merged_identity(world, registry()));
  EXPECT_NE(merged_identity(tilted, registry()), merged_identity(world, registry()));
}

TEST(Spacing, ThatReachesTooFarIsRefused) {
  const auto problem = [](std::string_view of_trees) {
    const auto world = parse_world(wood(of_trees), "wood.toml", registry());
    return world ? std::string() : world.error().message;
  };
  EXPECT_EQ(problem("spacing_m = 100"), "");
  EXPECT_NE(problem("spacing_m = 300").find("4 sides of a block, 256 m"), std::string::npos);
  EXPECT_NE(problem("spacing_m = 250").find("others within reach"), std::string::npos);
  EXPECT_NE(problem("footprint_m = 40").find("at most 32 m"), std::string::npos);
  EXPECT_NE(problem("spacing_m = -1").find("spacing_m"), std::string::npos);
  EXPECT_NE(problem("spacing_m = nan").find("spacing_m"), std::string::npos);
}

}  // namespace
}  // namespace psygen::world
