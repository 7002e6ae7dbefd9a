#include "engine/amplify/block_synthesiser.hpp"

#include <gtest/gtest.h>

#include "engine/models/terrain/terrain.hpp"
#include "engine/world/edits/edits.hpp"
#include "tests/engine/amplify/throwing_type.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::amplify {
namespace {

using world::testing::kSmallWorld;
using world::testing::parsed;
using world::testing::registry;

Totals totals_of(const world::World& world, core::BlockCoord block, int level = 0) {
  Totals totals;
  BlockSynthesiser(world, registry(), level).synthesise(block, totals);
  return totals;
}

TEST(BlockSynthesiser, MakesTheTerrainAndAllModelsOnIt) {
  const world::World world = parsed(kSmallWorld);
  Totals totals;
  std::uint64_t triangles = 0, bytes = 0;
  std::vector<std::uint32_t> indices;
  BlockSynthesiser synthesiser(world, registry());
  synthesiser.synthesise({2, 1}, totals, [&](const BlockMesh& mesh) {
    indices.push_back(mesh.placement.index);
    EXPECT_EQ(mesh.size, registry()[mesh.placement.model].mesh_size(mesh.placement.parameters, 0));
    triangles += mesh.size.triangle_count();
    bytes += mesh.view.vertices.size() + mesh.view.indices.size_bytes();
  });
  EXPECT_EQ(indices, (std::vector<std::uint32_t>{world::kTerrainIndex, 0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(totals.blocks, 1u);
  EXPECT_EQ(totals.models, 8u);
  EXPECT_EQ(totals.failed, 0u);
  EXPECT_EQ(totals.bytes, bytes);
  // Skirts do not count: two triangles for each of the 4 · 32 border vertices.
  EXPECT_EQ(totals.triangles + 2 * 4 * 32, triangles);
}

TEST(BlockSynthesiser, TheHashDependsOnWorldBlockAndLevelsOnly) {
  world::World world = parsed(kSmallWorld);
  const std::uint64_t hash = totals_of(world, {2, 1}).hash.value();
  EXPECT_EQ(totals_of(world, {2, 1}).hash.value(), hash);
  EXPECT_NE(totals_of(world, {1, 2}).hash.value(), hash);
  EXPECT_NE(totals_of(world, {2, 1}, kAllLevels).hash.value(), hash);
  world.seed += 1;
  EXPECT_NE(totals_of(world, {2, 1}).hash.value(), hash);
}

TEST(BlockSynthesiser, EditsChangeTheHashOfTheirBlocksUntilTheyAreUndone) {
  const world::World function = parsed(kSmallWorld);
  const std::uint64_t felled_block = totals_of(function, {2, 1}).hash.value();
  const std::uint64_t other_block = totals_of(function, {6, 3}).hash.value();
  world::World world = function;
  world::Edits edits;
  ASSERT_TRUE(edits.remove(world, {{2, 1}, 0}));
  world::set_edits(world, edits.layer());
  const Totals felled = totals_of(world, {2, 1});
  EXPECT_EQ(felled.models, 7u);
  EXPECT_NE(felled.hash.value(), felled_block);
  ASSERT_TRUE(edits.raise(world, {{2, 1}, {30, 0, 30}}, 10, 5));
  world::set_edits(world, edits.layer());
  EXPECT_NE(totals_of(world, {2, 1}).hash.value(), felled.hash.value());
  EXPECT_EQ(totals_of(world, {2, 1}).hash.value(), totals_of(world, {2, 1}).hash.value());
  EXPECT_EQ(totals_of(world, {6, 3}).hash.value(), other_block);
  world::set_edits(world, nullptr);
  EXPECT_EQ(totals_of(world, {2, 1}).hash.value(), felled_block);
}

TEST(BlockSynthesiser, ALevelIsTheCoarsestOfTypesThatHaveFewer) {
  const world::World world = parsed(kSmallWorld);
  Totals totals;
  BlockSynthesiser(world, registry(), 99).synthesise({2, 1}, totals, [](const BlockMesh& mesh) {
    EXPECT_EQ(mesh.level,
              registry()[mesh.placement.model].level_count_of(mesh.placement.parameters) - 1);
  });
  EXPECT_EQ(totals.hash.count(), 9u);
  EXPECT_LT(totals.triangles, totals_of(world, {2, 1}).triangles / 50);
}

TEST(BlockSynthesiser, TheHashDetectsAMovedModel) {
  // A filter that moves the same models: the meshes of rocks do not change.
  const world::World world = parsed(kSmallWorld);
  world::World moved = world;
  for (world::Scatter& scatter : moved.scatter)
    scatter.max_slope_deg = 9;
  const Totals a = totals_of(world, {2, 1}), b = totals_of(moved, {2, 1});
  ASSERT_EQ(a.triangles, b.triangles) << "every model found a place";
  EXPECT_NE(a.hash.value(), b.hash.value());
}

TEST(BlockSynthesiser, MemoryThatWasUsedBeforeLeavesNoTrace) {
  const world::World world = parsed(kSmallWorld);
  BlockSynthesiser synthesiser(world, registry());
  Totals first, second;
  synthesiser.synthesise({0, 0}, first);
  synthesiser.synthesise({2, 1}, second);
  EXPECT_EQ(second.hash.value(), totals_of(world, {2, 1}).hash.value());
}

TEST(BlockSynthesiser, AModelThatThrowsIsCountedAndTheOthersAreMade) {
  const ThrowingWorld throwing;
  Totals totals;
  BlockSynthesiser(throwing.world, throwing.registry).synthesise({0, 0}, totals);
  EXPECT_EQ(totals.failed, 2u);
  EXPECT_EQ(totals.models, 10u);
  EXPECT_NE(totals.first_failure.find("no geometry today"), std::string::npos);
  EXPECT_EQ(totals.hash.count(), 9u);
}

TEST(SampleWorldHash, DependsOnTheWorldAndThePosition) {
  world::World world = parsed(kSmallWorld);
  const auto hash = sample_world_hash(world, registry(), {2, 2});
  ASSERT_TRUE(hash);
  EXPECT_EQ(sample_world_hash(world, registry(), {2, 2}), hash);
  EXPECT_NE(sample_world_hash(world, registry(), {3, 2}), hash);
  world.seed += 1;
  EXPECT_NE(sample_world_hash(world, registry(), {2, 2}), hash);
}

TEST(SampleWorldHash, IsDefinedAtTheLimitOfBlockCoordinates) {
  world::World world = parsed(kSmallWorld);
  world.blocks_x = world.blocks_z = 0;
  const auto corner = sample_world_hash(world, registry(), {INT32_MAX, INT32_MAX});
  ASSERT_TRUE(corner);
  EXPECT_NE(corner, sample_world_hash(world, registry(), {INT32_MAX, INT32_MAX - 2}));
}

TEST(SampleWorldHash, IsNothingIfAMeshFails) {
  ThrowingWorld throwing;
  EXPECT_FALSE(sample_world_hash(throwing.world, throwing.registry, {0, 0}));
  throwing.throws = false;
  EXPECT_TRUE(sample_world_hash(throwing.world, throwing.registry, {0, 0}));
}

}  // namespace
}  // namespace psygen::amplify
