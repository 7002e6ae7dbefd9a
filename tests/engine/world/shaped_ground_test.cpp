// Stamps and roads as one layer of a world: in nodes, hashes, edits and merged models.
#include "engine/world/shaped_ground.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/edits/edit_bytes.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/placement.hpp"
#include "tests/engine/world/ground_meshes.hpp"
#include "tests/engine/world/shaped_worlds.hpp"

namespace psygen::world {
namespace {

using testing::ground_hashes;
using testing::height_at;
using testing::kQuantumM;
using testing::kShapes;
using testing::kSmallWorld;
using testing::mesh_of;
using testing::parsed;
using testing::read_shaped_world;
using testing::registry;
using testing::replaced;
using testing::shaped_world;

TEST(ShapedGround, IsTheSameInEveryNodeThatHasAVertex) {
  const World world = shaped_world(kShapes);
  const World base = parsed(kSmallWorld);
  const auto heights = [&](const World& of, core::BlockCoord node, int level) {
    std::vector<int> values;
    for (const core::TerrainVertex& v : mesh_of(of, node, level, 0))
      values.push_back(v.height);
    return values;
  };
  std::size_t changed = 0;
  for (int level = 0; level < 3; ++level) {
    const auto here = heights(world, {0, 0}, level), east = heights(world, {1, 0}, level);
    const auto plain = heights(base, {0, 0}, level);
    for (std::size_t k = 0; k < 33; ++k)
      EXPECT_EQ(here[k * 33 + 32], east[k * 33]) << level;
    for (std::size_t i = 0; i < 33 * 33; ++i)
      changed += here[i] != plain[i] ? 1 : 0;
    if (level == 0) continue;
    const auto child = heights(world, {0, 0}, level - 1);
    for (std::size_t z = 0; z < 17; ++z)
      for (std::size_t x = 0; x < 17; ++x)
        EXPECT_EQ(here[z * 33 + x], child[2 * z * 33 + 2 * x]) << level;
  }
  EXPECT_GT(changed, 500U);
}

TEST(ShapedGround, WorldsWithoutItHaveTheirOldHashes) {
  const World world = parsed(kSmallWorld);
  EXPECT_EQ(shape_hash(world), 0U);
  EXPECT_EQ(world.shaped.layer, nullptr);
  EXPECT_EQ(world.terrain.edits(), nullptr);
  const World shaped = shaped_world(kShapes);
  EXPECT_NE(shape_hash(shaped), 0U);
  EXPECT_EQ(shape_hash(shaped), shape_hash(shaped_world(kShapes)));
  EXPECT_NE(merged_identity(world, registry()), merged_identity(shaped, registry()));
  // Blocks outside of all shapes keep the keys of their meshes.
  const World small = shaped_world(
      "[[stamp]]\nimage = \"white.png\"\ncentre_m = [20, 20]\nsize_m = 4\nborder_m = 1\n");
  EXPECT_NE(terrain_parameters(small, {0, 0}), terrain_parameters(world, {0, 0}));
  EXPECT_EQ(terrain_parameters(small, {6, 3}), terrain_parameters(world, {6, 3}));
  EXPECT_EQ(terrain_parameters(small, {6, 3}).hash(), terrain_parameters(world, {6, 3}).hash());
}

TEST(ShapedGround, MeshesAndTheirKeysKeepTheirHashes) {
  World world = shaped_world(kShapes);
  Edits edits;
  ASSERT_TRUE(edits.raise(world, {{2, 1}, {10, 0, 20}}, 30, 5));
  set_edits(world, edits.layer());
  const auto [keys, meshes] = ground_hashes(world);
  EXPECT_EQ(keys, 0x47fcd45ea2a74ac6U) << std::hex << keys;
  EXPECT_EQ(meshes, 0xfce9c41d0a21abfU) << std::hex << meshes;
}

TEST(ShapedGround, EveryKeyOfItIsPartOfItsHash) {
  const std::uint64_t hash = shape_hash(shaped_world(kShapes));
  for (const auto& [from, to] : {std::pair{"ramp.png", "white.png"},
                                 {"[128, 128]", "[128, 129]"},
                                 {"size_m = 96", "size_m = 97"},
                                 {"base_m = 4", "base_m = 5"},
                                 {"height_m = 20", "height_m = 21"},
                                 {"border_m = 16", "border_m = 17"},
                                 {"turn_deg = 30", "turn_deg = 31"},
                                 {"turn_deg = 30", "mode = \"set\"\nturn_deg = 30"},
                                 {"[260, 60]", "[260, 61]"},
                                 {"width_m = 10", "width_m = 11"},
                                 {"border_m = 8", "border_m = 9"},
                                 {"clear_m = 2", "clear_m = 3"},
                                 {"clear_m = 2", "clear_m = 2\nsmoothing_m = 50"}})
    EXPECT_NE(shape_hash(shaped_world(replaced(kShapes, from, to))), hash) << to;
}

TEST(ShapedGround, EditsLieOverItAndAreStoredWithoutIt) {
  World world = shaped_world(kShapes);
  const World function = world;
  const double road_m = height_at(world, 140, 140), far_m = height_at(world, 480, 240);
  Edits edits;
  ASSERT_TRUE(edits.raise(world, {{0, 0}, {140, 0, 140}}, 12, 3));
  set_edits(world, edits.layer());
  EXPECT_NEAR(height_at(world, 140, 140), road_m + 3, 2 * kQuantumM);
  EXPECT_EQ(height_at(world, 480, 240), far_m);
  EXPECT_EQ(terrain_parameters(world, {7, 3}), terrain_parameters(function, {7, 3}));
  // The bytes of a save restore the same world.
  Edits loaded;
  const core::BlockCoord block{2, 2};
  const auto bytes = encode_block(edits, registry(), block);
  EXPECT_LT(bytes.size(), 200U);
  ASSERT_TRUE(load_block(loaded, world, registry(), block, bytes));
  World again = function;
  set_edits(again, loaded.layer());
  EXPECT_EQ(height_at(again, 140, 140), height_at(world, 140, 140));
  EXPECT_EQ(terrain_parameters(again, {2, 2}), terrain_parameters(world, {2, 2}));
  // Setting the world's own edits again changes nothing.
  const Edits of_world(world.edits);
  EXPECT_TRUE(changed_blocks(edits, of_world).empty());
  set_edits(again, of_world.layer());
  EXPECT_EQ(height_at(again, 140, 140), height_at(world, 140, 140));
  // Another world has different ground below the same edits.
  World other = parsed(kSmallWorld);
  const double plain_m = height_at(other, 140, 140);
  set_edits(other, of_world.layer());
  EXPECT_NEAR(height_at(other, 140, 140), std::min(plain_m + 3, 60.0), 2 * kQuantumM);
  set_edits(world, nullptr);
  EXPECT_EQ(world, function);
  EXPECT_EQ(height_at(world, 140, 140), road_m);
}

TEST(ShapedGround, ModelsKeepTheirPlacesWhenEditsComeAndGo) {
  World world = shaped_world(kShapes);
  std::vector<Placement> before, after;
  place_models(world, registry(), {2, 2}, before);
  Edits edits;
  ASSERT_TRUE(edits.raise(world, {{0, 0}, {140, 0, 140}}, 60, 9));
  set_edits(world, edits.layer());
  place_models(world, registry(), {2, 2}, after);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].position.x, after[i].position.x);
    EXPECT_EQ(before[i].position.z, after[i].position.z);
  }
}

// The merged meshes of nodes stand on the same ground and leave the road free.
TEST(ShapedGround, MergedModelsAreOnItAndNotOnRoads) {
  const std::string many =
      replaced(replaced(kSmallWorld, "count = 3", "count = 0"), "count = 5", "count = 200");
  const std::string tables =
      "[[road]]\npoints_m = [[4, 64], [250, 64]]\nwidth_m = 20\nclear_m = 8\n"
      "[[stamp]]\nimage = \"white.png\"\ncentre_m = [64, 20]\nsize_m = 30\nheight_m = 25\n"
      "border_m = 0\n";
  const auto make = [&](const World& world) {
    const auto merged = make_merged_type(std::make_shared<const World>(world), registry());
    const models::Parameters p = merged_parameters(world, {0, 0}, 1);
    return models::test::synthesise(*merged, p, 0);
  };
  const auto plain = make(parsed(many)), shaped = make(*read_shaped_world(tables, many));
  EXPECT_LT(shaped.box.max.y, plain.box.max.y + 30);
  EXPECT_GT(shaped.box.max.y, plain.box.max.y + 5);
  EXPECT_NE(plain.vertex_bytes, shaped.vertex_bytes);
}

}  // namespace
}  // namespace psygen::world
