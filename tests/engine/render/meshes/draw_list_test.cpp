#include "engine/render/meshes/draw_list.hpp"

#include <gtest/gtest.h>

#include <array>

namespace psygen::render {
namespace {

MeshDraw model(std::uint32_t block, std::uint32_t first_vertex, std::uint32_t shared) {
  MeshDraw draw;
  draw.range.pool_block = block;
  draw.range.first_vertex = first_vertex;
  draw.range.first_index = 1000 + first_vertex;
  draw.range.index_count = 6;
  draw.range.layout = core::VertexLayout::kModel;
  draw.shared_indices = shared;
  return draw;
}

TEST(DrawList, GathersDrawsOfTheSameBuffersAndKeepsTheirOrder) {
  const std::vector<MeshDraw> models{model(0, 1, 0), model(0, 2, 1), model(1, 3, 0),
                                     model(0, 4, 0), model(0, 5, 1), model(1, 6, 0)};
  const std::vector<IndexList> lists{{7, 9}};
  DrawList list;
  list.build({.shared = lists}, {}, models);
  ASSERT_EQ(list.runs().size(), 3u);
  std::vector<std::int32_t> order;
  for (const IndexedDraw& draw : list.draws())
    order.push_back(draw.vertex_offset);
  EXPECT_EQ(order, (std::vector<std::int32_t>{1, 4, 2, 5, 3, 6}));
  EXPECT_TRUE(list.runs()[1].shared);
  EXPECT_EQ(list.draws()[2].first_index, 7u);
  EXPECT_EQ(list.draws()[2].index_count, 9u);
  EXPECT_EQ(list.draws()[0].first_index, 1001u);
  EXPECT_EQ(list.triangle_count(), 4u * 2 + 2u * 3);
}

TEST(DrawList, ChangesTheOrderOnlyWithinAWindow) {
  std::vector<MeshDraw> models;
  for (std::uint32_t i = 0; i < 2 * DrawList::kWindow; ++i)
    models.push_back(model(1 - i % 2, i, 0));
  DrawList list;
  list.build({}, {}, models);
  ASSERT_EQ(list.draws().size(), models.size());
  for (std::size_t i = 0; i < models.size(); ++i) {
    const auto was = static_cast<std::size_t>(list.draws()[i].vertex_offset);
    EXPECT_EQ(i / DrawList::kWindow, was / DrawList::kWindow);
  }
  EXPECT_LE(list.runs().size(), 4u);
}

TEST(DrawList, PushesTheDataOfLargeMeshesOnly) {
  const std::vector<MeshDraw> models{model(0, 1, 0), model(0, 2, 1), model(0, 3, 0)};
  const std::vector<IndexList> lists{{0, 600}};
  DrawList list;
  list.build({.shared = lists, .pushed_from = 100}, {}, models);
  ASSERT_EQ(list.runs().size(), 2u);
  EXPECT_TRUE(list.runs()[0].pushed);
  EXPECT_EQ(list.runs()[0].count, 1u);
  EXPECT_FALSE(list.runs()[1].pushed);
  EXPECT_EQ(list.runs()[1].count, 2u);
}

TEST(DrawList, PutsTerrainFirstAndFoldsItsLeastHeightIntoTheOrigin) {
  TerrainDraw ground;
  ground.range.layout = core::VertexLayout::kTerrain;
  ground.range.index_count = 3;
  ground.origin = {1, 2, 3};
  ground.height_min_m = 10;
  ground.height_range_m = 50;
  ground.cell_m = 0.5F;
  const std::vector<MeshDraw> models{model(0, 1, 0)};
  DrawList list;
  list.build({}, std::span(&ground, 1), models);
  ASSERT_EQ(list.runs().size(), 2u);
  EXPECT_EQ(list.runs()[0].layout, core::VertexLayout::kTerrain);
  EXPECT_EQ(list.data()[0].origin, glm::vec4(1, 12, 3, 0.5F));
  EXPECT_EQ(list.data()[0].scale.x, 50.0F);
}

TEST(DrawList, DrawsNearTerrainApartAndBeforeTheRestOfItsWindow) {
  std::vector<TerrainDraw> terrain(4);
  for (std::uint32_t i = 0; i < 4; ++i) {
    terrain[i].range.layout = core::VertexLayout::kTerrain;
    terrain[i].range.first_vertex = i;
    terrain[i].near = i == 0 || i == 2;
  }
  DrawList list;
  list.build({}, terrain, {});
  ASSERT_EQ(list.runs().size(), 2u);
  EXPECT_EQ(list.runs()[0].coverage, Coverage::kPart);
  EXPECT_EQ(list.runs()[1].coverage, Coverage::kWhole);
  EXPECT_EQ(list.draws()[1].vertex_offset, 2);
  EXPECT_EQ(list.draws()[2].vertex_offset, 1);
}

TEST(DrawList, DrawsFadingModelsAfterTheRestOfTheirWindow) {
  std::vector<MeshDraw> draws(5, model(0, 0, 0));
  draws[0].fade = 0.5F;
  draws[2].fade = -0.5F;
  draws[3].fade = 0.0F;
  DrawList list;
  list.build({}, {}, draws);
  ASSERT_EQ(list.runs().size(), 2u);
  EXPECT_EQ(list.runs()[0].coverage, Coverage::kWhole);
  EXPECT_EQ(list.runs()[0].count, 2u);
  EXPECT_EQ(list.runs()[1].coverage, Coverage::kPart);
  EXPECT_EQ(list.runs()[1].count, 3u);
  EXPECT_EQ(list.data()[0].scale.w, 1.0F);
  EXPECT_EQ(list.data()[2].scale.w, 0.5F);
  EXPECT_EQ(list.data()[3].scale.w, -0.5F);
  EXPECT_EQ(list.data()[4].scale.w, 0.0F);
}

TEST(DrawList, DrawsNearModelsFirstWhetherTheyFadeOrNot) {
  std::vector<MeshDraw> draws(6, model(0, 0, 0));
  draws[1].near = draws[3].near = draws[5].near = true;
  draws[2].fade = draws[3].fade = 0.5F;
  draws[5].pictured = true;
  DrawList list;
  list.build({}, {}, draws);
  ASSERT_EQ(list.runs().size(), 4u);
  constexpr std::array kOrder{Coverage::kNear, Coverage::kWhole, Coverage::kPart,
                              Coverage::kPictured};
  for (std::size_t i = 0; i < kOrder.size(); ++i)
    EXPECT_EQ(list.runs()[i].coverage, kOrder[i]);
  EXPECT_EQ(list.runs()[0].count, 2u);
}

TEST(DrawList, DrawsThePartThatIsAskedForOfOwnAndOfSharedIndices) {
  MeshDraw own = model(0, 0, 0);
  own.range.first_index = 300;
  own.range.index_count = 90;
  own.part = {30, 12};
  TerrainDraw shared;
  shared.range.layout = core::VertexLayout::kTerrain;
  shared.shared_indices = 1;
  shared.part = {6, 9};
  const IndexList lists[] = {{1000, 60}};
  DrawList list;
  list.build({.shared = lists}, std::span(&shared, 1), std::span(&own, 1));
  ASSERT_EQ(list.draws().size(), 2u);
  EXPECT_EQ(list.draws()[0].first_index, 1006u);
  EXPECT_EQ(list.draws()[0].index_count, 9u);
  EXPECT_EQ(list.draws()[1].first_index, 330u);
  EXPECT_EQ(list.draws()[1].index_count, 12u);
  EXPECT_EQ(list.triangle_count(), 7u);
}

TEST(DrawList, IsEmptyAgainWhenBuiltFromNothing) {
  const std::vector<MeshDraw> models{model(0, 1, 0)};
  DrawList list;
  list.build({}, {}, models);
  list.build({}, {}, {});
  EXPECT_TRUE(list.runs().empty());
  EXPECT_TRUE(list.draws().empty());
  EXPECT_EQ(list.triangle_count(), 0u);
}

}  // namespace
}  // namespace psygen::render
