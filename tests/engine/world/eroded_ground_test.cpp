// Erosion as a part of a world: in files, nodes of all levels, queries, hashes and edits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/edits/edits.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/files/world_schema.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/world_parts.hpp"
#include "tests/engine/world/ground_meshes.hpp"
#include "tests/engine/world/shaped_worlds.hpp"

namespace psygen::world {
namespace {

using testing::expect_equal_seams;
using testing::ground_hashes;
using ::testing::HasSubstr;
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

constexpr const char* kErosion = "[erosion]\nstrength = 0.6\ngully_m = 60\nsediment_m = 40\n";
constexpr std::size_t kSide = 33;  // vertices of a block of the small world

TEST(ErodedGround, AgreesAlongTheSeamsOfNodesOfALevel) {
  const World world = shaped_world(kErosion);
  const World plain = parsed(kSmallWorld);
  for (int level = 0; level < 5; ++level) {
    expect_equal_seams(world, {0, 0}, level);
    const auto here = mesh_of(world, {0, 0}, level, 0), before = mesh_of(plain, {0, 0}, level, 0);
    std::size_t changed = 0;
    for (std::size_t i = 0; i < kSide * kSide; ++i)
      changed += here[i].height != before[i].height ? 1 : 0;
    EXPECT_GT(changed, kSide * kSide / 2) << level;
  }
}

TEST(ErodedGround, MorphsIntoTheHeightsOfTheParent) {
  const World world = shaped_world(kErosion);
  const int size = static_cast<int>(kSide);
  const models::TerrainGrid grid(size, 1);
  const auto n = static_cast<std::size_t>(grid.n);
  int differing = 0;
  for (int level = 0; level < 4; ++level) {
    const auto child = mesh_of(world, {2, 2}, level, 1),
               parent = mesh_of(world, {1, 1}, level + 1, 1);
    for (std::size_t z = 0; z < n; z += 2) {
      for (std::size_t x = 0; x < n; x += 2) {
        const core::TerrainVertex& vertex = child[z * n + x];
        ASSERT_EQ(vertex.coarse_height, parent[z / 2 * n + x / 2].height) << level;
        differing += vertex.coarse_height != vertex.height ? 1 : 0;
      }
    }
  }
  EXPECT_GT(differing, 20);  // coarser nodes leave out small gullies
}

TEST(ErodedGround, KeepsTheMeanHeightOfTheLand) {
  const World world = shaped_world(kErosion), plain = parsed(kSmallWorld);
  double after = 0, before = 0;
  for (int z = 0; z < 40; ++z) {
    for (int x = 0; x < 40; ++x) {
      const core::BlockCoord node{x * 3 - 60, z * 3 - 60};
      after += mesh_of(world, node, 0, 3)[5].height;
      before += mesh_of(plain, node, 0, 3)[5].height;
    }
  }
  EXPECT_NEAR(after / before, 1, 0.06);
}

TEST(ErodedGround, OfQueriesEqualsThatOfMeshes) {
  const World world = shaped_world(std::string(kErosion) + kShapes);
  for (const core::BlockCoord block : {core::BlockCoord{0, 0}, {2, 1}, {7, 3}}) {
    const auto mesh = mesh_of(world, block, 0, 0);
    const std::vector<std::uint16_t> heights = ground_of_block(world, block);
    for (std::size_t i = 0; i < kSide * kSide; i += 7) {
      ASSERT_EQ(heights[i], mesh[i].height);
      const double at_m = models::ground_height_m(terrain_parameters(world, block), block,
                                                  2.0 * static_cast<double>(i % kSide),
                                                  2.0 * static_cast<double>(i / kSide));
      ASSERT_NEAR(at_m, heights[i] * kQuantumM, 1e-9);
    }
  }
}

TEST(ErodedGround, LiesBelowStampsRoadsAndEdits) {
  World world = shaped_world(std::string(kErosion) + kShapes);
  // The road follows the eroded ground where it does not cross the stamp.
  const World bare = shaped_world(kErosion), road = shaped_world(kShapes);
  EXPECT_NEAR(height_at(world, 20, 30), height_at(bare, 20, 30), 6);
  EXPECT_GT(std::abs(height_at(world, 440, 150) - height_at(road, 440, 150)), 2 * kQuantumM);
  const double before_m = height_at(world, 480, 240);
  Edits edits;
  ASSERT_TRUE(edits.raise(world, {{7, 3}, {32, 0, 48}}, 12, 3));
  set_edits(world, edits.layer());
  EXPECT_NEAR(height_at(world, 480, 240), before_m + 3, 2 * kQuantumM);
  EXPECT_EQ(height_at(world, 20, 30),
            height_at(shaped_world(std::string(kErosion) + kShapes), 20, 30));
}

TEST(ErodedGround, ChangesTheKeysOfAllMeshes) {
  const World world = shaped_world(kErosion), plain = parsed(kSmallWorld);
  EXPECT_NE(shape_hash(world), 0U);
  EXPECT_EQ(shape_hash(world), shape_hash(shaped_world(kErosion)));
  EXPECT_NE(merged_identity(world, registry()), merged_identity(plain, registry()));
  for (const int level : {0, 1, 5}) {
    const models::Parameters p = terrain_parameters(world, {6, 3}, level);
    EXPECT_NE(p.hash(), terrain_parameters(plain, {6, 3}, level).hash());
    const World other = shaped_world(replaced(kErosion, "gully_m = 60", "gully_m = 61"));
    EXPECT_NE(p.hash(), terrain_parameters(other, {6, 3}, level).hash());
  }
  EXPECT_NE(world_hash(world, registry()), world_hash(plain, registry()));
  EXPECT_NE(parts_of(world, registry()).ground, parts_of(plain, registry()).ground);
}

TEST(ErodedGround, OfStrengthZeroIsThePlainWorld) {
  const World world = shaped_world(replaced(kErosion, "strength = 0.6", "strength = 0"));
  const World plain = parsed(kSmallWorld);
  EXPECT_EQ(shape_hash(world), 0U);
  EXPECT_EQ(world.shaped.layer, nullptr);
  EXPECT_EQ(terrain_parameters(world, {6, 3}), terrain_parameters(plain, {6, 3}));
  const std::string written = write_world(plain, registry());
  EXPECT_EQ(written.find("[erosion]"), std::string::npos);
}

TEST(ErodedGround, ReadsBackEqual) {
  const World world = shaped_world(std::string(kErosion) + "octaves = 3\nstrata = 0.25\n");
  EXPECT_EQ(world.shaped.erosion.octaves, 3);
  const auto again = read_shaped_world("", write_world(world, registry()));
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(*again, world);
  EXPECT_EQ(shape_hash(*again), shape_hash(world));
}

TEST(ErodedGround, WrongNumbersAreRejectedWithLineAndField) {
  const auto error = [](const std::string& tables) {
    const auto world = read_shaped_world(tables);
    return world ? "" : world.error().message;
  };
  for (const char* key : {"gully_m = 0", "gully_m = 6000", "octaves = 0", "octaves = 9", "wear = 2",
                          "sediment_m = -1", "strata_m = 0", "min_slope_deg = 90", "scree = nan",
                          "gullys_m = 5", "octaves = 2.5"}) {
    const std::string name(key, std::string(key).find(' '));
    EXPECT_THAT(error("[erosion]\nstrength = 0.5\n" + std::string(key) + "\n"),
                HasSubstr("erosion." + name))
        << key;
  }
  EXPECT_THAT(error("[erosion]\nstrength = 1.5\n"), HasSubstr("erosion.strength"));
  EXPECT_THAT(error("[erosion]\nmin_height_m = 9\nmax_height_m = 8\n"),
              HasSubstr("must not be above max_height_m"));
  EXPECT_EQ(error("[erosion]\n"), "");
}

TEST(ErodedGround, EditorsSeeItsFields) {
  const std::string text = kSmallWorld + std::string(kErosion);
  const auto world = read_shaped_world("", text);
  ASSERT_TRUE(world);
  const auto sections = world_schema(text, *world, registry());
  ASSERT_TRUE(sections);
  const auto section = std::ranges::find(*sections, SectionKind::kErosion, &WorldSection::kind);
  ASSERT_NE(section, sections->end());
  EXPECT_TRUE(section->is_set);
  std::size_t fields = 0;
  models::visit_erosion(world->shaped.erosion,
                        [&](std::string_view, const auto&, const auto&) { ++fields; });
  EXPECT_EQ(section->fields.size(), fields);
}

TEST(ErodedGround, HasErrorsAndCostsOfItsDetails) {
  const World world = shaped_world(kErosion), plain = parsed(kSmallWorld);
  const models::ModelType& terrain = registry()[world.terrain_model];
  const models::Parameters p = terrain_parameters(world, {0, 0});
  const models::DetailErrors one = models::terrain_detail_errors_m(p, 1),
                             three = models::terrain_detail_errors_m(p, 3);
  EXPECT_GT(one.bound_m, 0);
  EXPECT_GT(three.bound_m, one.bound_m);
  EXPECT_LE(three.usual_m, three.bound_m);
  EXPECT_EQ(models::terrain_detail_errors_m(terrain_parameters(plain, {0, 0}), 3).bound_m, 0);
  // The bound holds at the vertices that a node shares with its parent.
  for (int level = 0; level < 3; ++level) {
    const double bound_m =
        models::terrain_detail_errors_m(terrain_parameters(world, {0, 0}, level), 1).bound_m;
    for (const core::TerrainVertex& v : mesh_of(world, {0, 0}, level, 1)) {
      if (v.grid_x % 2 != 0 || v.grid_z % 2 != 0) continue;
      ASSERT_LE(std::abs(v.height - v.coarse_height) * kQuantumM, bound_m + 2 * kQuantumM) << level;
    }
  }
  EXPECT_GT(terrain.steps(p, 0), 5 * terrain.steps(terrain_parameters(plain, {0, 0}), 0));
}

TEST(ErodedGround, KeepsItsMeshes) {
  const auto [keys, meshes] =
      ground_hashes(shaped_world(std::string(kErosion) + "strata = 0.5\n" + kShapes));
  EXPECT_EQ(keys, 0xf5cb69d4e55f8cfU) << std::hex << keys;
  EXPECT_EQ(meshes, 0xdddaf8c02e7df0dfU) << std::hex << meshes;
}

}  // namespace
}  // namespace psygen::world
