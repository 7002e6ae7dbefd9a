// Strength, masks and switches of the shapes of a world file.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "engine/models/terrain/terrain.hpp"
#include "engine/world/water.hpp"
#include "tests/engine/world/ground_meshes.hpp"
#include "tests/engine/world/river_world.hpp"
#include "tests/engine/world/shaped_worlds.hpp"

namespace psygen::world {
namespace {

using testing::each_vertex;
using testing::expect_equal_seams;
using testing::ground_hashes;
using testing::ground_in;
using testing::height_at;
using ::testing::IsEmpty;
using testing::kBrookLand;
using testing::kBrookTable;
using testing::kLakeTable;
using testing::kQuantumM;
using testing::kRiverTable;
using testing::kShapes;
using testing::kSmallWorld;
using testing::mesh_of;
using testing::parsed;
using testing::replaced;
using testing::shaped_world;

const std::string kHill =
    "[[stamp]]\nimage = \"white.png\"\ncentre_m = [200, 128]\nsize_m = 160\nheight_m = 8\n"
    "border_m = 20\n";

std::vector<double> heights_of(const World& world) {
  std::vector<double> heights;
  each_vertex([&](double x, double z) { heights.push_back(height_at(world, x, z)); });
  return heights;
}

std::vector<double> changes(const World& world) {
  static const std::vector<double> base = heights_of(parsed(kSmallWorld));
  std::vector<double> heights = heights_of(world);
  for (std::size_t i = 0; i < base.size(); ++i)
    heights[i] -= base[i];
  return heights;
}

TEST(StampMask, StrengthIsAFractionOfTheChange) {
  for (const char* mode : {"add", "set", "highest", "lowest"}) {
    const std::string stamp = kHill + "base_m = 3\nmode = \"" + mode + "\"\n";
    const auto full = changes(shaped_world(stamp)),
               half = changes(shaped_world(stamp + "strength = 0.25\n"));
    std::size_t moved = 0;
    for (std::size_t i = 0; i < full.size(); ++i) {
      ASSERT_NEAR(half[i], 0.25 * full[i], 1.01 * kQuantumM) << mode;
      moved += std::abs(full[i]) > 1 ? 1 : 0;
    }
    EXPECT_GT(moved, 100U) << mode;
  }
}

TEST(StampMask, HighestFillsAndLowestCuts) {
  const std::string plate = kHill + "base_m = 3\nmode = \"set\"\n";
  const auto set = changes(shaped_world(plate));
  const auto highest = changes(shaped_world(replaced(plate, "\"set\"", "\"highest\"")));
  const auto lowest = changes(shaped_world(replaced(plate, "\"set\"", "\"lowest\"")));
  std::size_t up = 0, down = 0;
  for (std::size_t i = 0; i < set.size(); ++i) {
    ASSERT_EQ(highest[i], std::max(set[i], 0.0)) << i;
    ASSERT_EQ(lowest[i], std::min(set[i], 0.0)) << i;
    up += set[i] > 0 ? 1 : 0;
    down += set[i] < 0 ? 1 : 0;
  }
  EXPECT_GT(up, 100U);
  EXPECT_GT(down, 100U);
}

TEST(StampMask, ShapesThatAreOffLeaveTheWorldAsWithoutThem) {
  const World without = shaped_world(kShapes);
  const auto expected = ground_hashes(without);
  for (const char* off : {"enabled = false\n", "strength = 0\n"}) {
    const World world = shaped_world(kHill + off + kShapes);
    EXPECT_EQ(heights_of(world), heights_of(without));
    const auto hashes = ground_hashes(world);
    EXPECT_EQ(hashes.keys, expected.keys);
    EXPECT_EQ(hashes.meshes, expected.meshes);
    EXPECT_EQ(shaped_world(kHill + off).shaped.layer, nullptr);
  }
  const std::string road = "[[road]]\npoints_m = [[20, 200], [300, 220]]\n";
  const World no_road = shaped_world(kShapes + road + "enabled = false\n");
  EXPECT_EQ(shape_hash(no_road), shape_hash(without));
  EXPECT_EQ(road_at(no_road, {2, 3}, {20, 18}), 0);
}

TEST(StampMask, ARoadOfStrengthZeroIsASurfaceOnTheGroundAsItIs) {
  const std::string road = "[[road]]\npoints_m = [[20, 200], [300, 220]]\nwidth_m = 20\n";
  const World base = parsed(kSmallWorld), level = shaped_world(road);
  const World painted = shaped_world(road + "strength = 0\n");
  EXPECT_EQ(heights_of(painted), heights_of(base));
  EXPECT_NE(heights_of(level), heights_of(base));
  const auto at = painted.position({160, 210});
  EXPECT_EQ(road_at(painted, at.block, {at.local.x, at.local.z}), 1);
  const auto half = changes(shaped_world(road + "strength = 0.5\n")), full = changes(level);
  for (std::size_t i = 0; i < full.size(); ++i)
    ASSERT_NEAR(half[i], 0.5 * full[i], 1.01 * kQuantumM);
}

TEST(StampMask, AnImageCoversTheStampOrAnArea) {
  const std::string stamp = replaced(kHill, "border_m = 20", "border_m = 0");
  const World full = shaped_world(stamp);
  const World own = shaped_world(stamp + "turn_deg = 90\nmask_image = \"ramp.png\"\n");
  const World area =
      shaped_world(stamp + "mask_image = \"ramp.png\"\nmask_area_m = [160, 60, 260, 400]\n");
  const World base = parsed(kSmallWorld);
  std::size_t half = 0;
  each_vertex([&](double x, double z) {
    const double change = height_at(full, x, z) - height_at(base, x, z);
    // Black in the first corner, white in the last one. About +Y by 90 degrees: x becomes -z.
    const double u = (128 - z + 80) / 160, v = (x - 200 + 80) / 160;
    const auto grey = [](double at_u, double at_v) {
      const auto place = [](double t) { return std::clamp(t * 17 - 0.5, 0.0, 16.0); };
      return (place(at_u) + 17 * place(at_v)) / 288;
    };
    if (std::abs(x - 200) < 80 && std::abs(z - 128) < 80) {  // a turned border is rounded
      ASSERT_NEAR(height_at(own, x, z) - height_at(base, x, z), change * grey(u, v),
                  2.01 * kQuantumM);
    }
    const bool inside = x >= 160 && x <= 260 && z >= 60 && z <= 400;
    ASSERT_NEAR(height_at(area, x, z) - height_at(base, x, z),
                inside ? change * grey((x - 160) / 100, (z - 60) / 340) : 0, 2.01 * kQuantumM);
    half += inside && change > 4 ? 1 : 0;
  });
  EXPECT_GT(half, 500U);
}

const std::string kRanges =
    "min_height_m = 8\nheight_fade_m = 3\nmax_slope_deg = 20\nslope_fade_deg = 8\n"
    "mask_noise_m = 40\nmask_share = 0.6\n";

TEST(StampMask, MasksDoNotDependOnTheOrderOfStamps) {
  const std::string wide = replaced(kHill, "size_m = 160", "size_m = 230");
  const std::string dig = replaced(wide, "height_m = 8", "height_m = 3") + kRanges;
  const auto above = changes(shaped_world(wide + dig)), below = changes(shaped_world(dig + wide));
  const auto alone = changes(shaped_world(dig)), hill = changes(shaped_world(wide));
  std::size_t partly = 0;
  for (std::size_t i = 0; i < above.size(); ++i) {
    ASSERT_NEAR(above[i], below[i], 1.01 * kQuantumM) << i;
    ASSERT_NEAR(above[i], alone[i] + hill[i], 2.01 * kQuantumM) << i;
    partly += alone[i] > 0.2 && alone[i] < 2.8 ? 1 : 0;
  }
  EXPECT_GT(partly, 300U);
}

TEST(StampMask, NodesOfALevelAgreeAlongTheirSeams) {
  const World world = shaped_world(kHill + kRanges + "mask_image = \"ramp.png\"\n");
  for (int level = 0; level < 4; ++level) {
    for (const core::BlockCoord node : {core::BlockCoord{0, 0}, {2, 1}, {3, 2}})
      expect_equal_seams(world, node, level);
  }
  const auto here = mesh_of(world, {0, 0}, 2, 0), child = mesh_of(world, {0, 0}, 1, 0);
  for (std::size_t z = 0; z < 17; ++z)
    for (std::size_t x = 0; x < 17; ++x)
      ASSERT_EQ(here[z * 33 + x].height, child[2 * z * 33 + 2 * x].height);
}

TEST(StampMask, EveryKeyIsPartOfTheHashAndOfTheComparison) {
  const std::string stamp =
      kHill + kRanges + "mask_image = \"ramp.png\"\nmask_patches = 2\nmin_slope_deg = 1\n";
  const World world = shaped_world(stamp);
  for (const auto& [from, to] :
       {std::pair{"ramp.png", "white.png"},
        {"mask_patches = 2", "mask_patches = 3"},
        {"mask_noise_m = 40", "mask_noise_m = 41"},
        {"mask_share = 0.6", "mask_share = 0.7"},
        {"mask_patches = 2", "mask_patches = 2\nmask_area_m = [0, 0, 9, 9]"},
        {"mask_patches = 2", "mask_patches = 2\nstrength = 0.5"},
        {"mask_patches = 2", "mask_patches = 2\nmode = \"set\""},
        {"mask_patches = 2", "mask_patches = 2\nmode = \"highest\""},
        {"mask_patches = 2", "mask_patches = 2\nmode = \"lowest\""},
        {"mask_patches = 2", "mask_patches = 2\nmax_height_m = 40"},
        {"mask_patches = 2", "mask_patches = 2\nenabled = false"},
        {"min_height_m = 8", "min_height_m = 9"},
        {"height_fade_m = 3", "height_fade_m = 4"},
        {"min_slope_deg = 1", "min_slope_deg = 2"},
        {"max_slope_deg = 20", "max_slope_deg = 21"},
        {"slope_fade_deg = 8", "slope_fade_deg = 9"}}) {
    const World other = shaped_world(replaced(stamp, from, to));
    EXPECT_NE(shape_hash(other), shape_hash(world)) << to;
    EXPECT_FALSE(other == world) << to;
  }
}

TEST(StampMask, WaterThatIsOffLeavesTheWorldAsWithoutIt) {
  const std::string off = "enabled = false\n";
  const World without = parsed(std::string(kBrookLand) + kRiverTable);
  // The brook ends in the river, the first of the list, and the river passed through the lake.
  const World world =
      parsed(std::string(kBrookLand) + kLakeTable + off + kRiverTable + kBrookTable + off);
  EXPECT_THAT(world.shaped.warnings, ::testing::ElementsAreArray(without.shaped.warnings));
  std::size_t wet = 0;
  for (double z = 1600; z < 1780; z += 3) {
    for (double x = 1640; x < 1900; x += 3) {
      ASSERT_EQ(ground_in(world, {x, z}), ground_in(without, {x, z}));
      const auto at = world.position({x, z});
      const WaterPoint here = water_at(world, at), there = water_at(without, at);
      ASSERT_EQ(here.surface_m, there.surface_m);
      ASSERT_EQ(here.depth_m, there.depth_m);
      wet += here.depth_m > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(wet, 20U);
  EXPECT_EQ(bodies_hash(world.shaped.lakes), bodies_hash(std::vector<Lake>{}));
  EXPECT_EQ(bodies_hash(world.shaped.rivers), bodies_hash(without.shaped.rivers));
  const World dry = parsed(std::string(kBrookLand) + kLakeTable + off + kBrookTable + off);
  EXPECT_EQ(dry.shaped.layer, nullptr);
  EXPECT_FALSE(dry.shaped.has_water());
}

}  // namespace
}  // namespace psygen::world
