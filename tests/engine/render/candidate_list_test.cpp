#include "engine/render/candidate_list.hpp"

#include <gtest/gtest.h>

namespace psygen::render {
namespace {

MeshDraw model(std::uint32_t id, std::uint32_t block, std::uint32_t shared) {
  MeshDraw draw;
  draw.range.id = id;
  draw.range.pool_block = block;
  draw.range.first_vertex = 10 * id;
  draw.range.first_index = 100 * id;
  draw.range.index_count = 6;
  draw.shared_indices = shared;
  return draw;
}

TEST(CandidateList, gathers_levels_of_the_same_buffers_in_groups_with_room_for_all) {
  const std::vector<IndexList> lists{{7, 9}};
  std::vector<MeshDraw> models{model(1, 0, 0), model(2, 1, 0), model(3, 0, 1), model(4, 0, 0)};
  const std::vector<DrawLevel> coarser{{model(9, 1, 0).range, 0, 0.5F}};
  models[3].coarser = coarser;
  std::vector<TerrainDraw> terrain(1);
  terrain[0].range.layout = core::VertexLayout::kTerrain;
  terrain[0].shared_indices = 1;
  CandidateList list;
  list.build(terrain, models, lists, true);
  ASSERT_EQ(list.candidates().size(), 5u);
  ASSERT_EQ(list.levels().size(), 6u);
  ASSERT_EQ(list.groups().size(), 4u);
  EXPECT_EQ(list.groups()[0].layout, core::VertexLayout::kTerrain);
  EXPECT_EQ(list.groups()[1].capacity, 2u);
  EXPECT_EQ(list.groups()[2].capacity, 2u);
  EXPECT_EQ(list.groups()[2].pool_block, 1u);
  EXPECT_TRUE(list.groups()[3].shared);
  EXPECT_EQ(list.command_count(), 6u);
  EXPECT_EQ(std::vector<std::uint32_t>(list.first_commands().begin(), list.first_commands().end()),
            (std::vector<std::uint32_t>{0, 1, 3, 5}));
  EXPECT_EQ(list.levels()[3].draw, glm::uvec4(7, 9, 30, 3)) << "the shared list's indices";
  EXPECT_EQ(list.candidates()[4].levels, glm::uvec4(4, 2, 5, 0));
  EXPECT_EQ(list.levels()[5].draw, glm::uvec4(900, 6, 90, 2));
  EXPECT_EQ(list.levels()[5].error.x, 0.5F);
  EXPECT_EQ(list.name_count(), 6u);
}

TEST(CandidateList, takes_parts_of_a_mesh_as_candidates_of_one_name) {
  std::vector<MeshDraw> models{model(4, 0, 0), model(4, 0, 0)};
  models[0].range.index_count = models[1].range.index_count = 30;
  models[0].part = {0, 6};
  models[1].part = {12, 9};
  CandidateList list;
  list.build({}, models, {}, true);
  ASSERT_EQ(list.candidates().size(), 2u);
  EXPECT_EQ(list.levels()[0].draw, glm::uvec4(400, 6, 40, 0));
  EXPECT_EQ(list.levels()[1].draw, glm::uvec4(412, 9, 40, 0));
  EXPECT_EQ(list.candidates()[0].levels.z, list.candidates()[1].levels.z);
}

TEST(CandidateList, leaves_out_coarser_levels_where_nobody_chooses) {
  std::vector<MeshDraw> models{model(1, 0, 0)};
  const std::vector<DrawLevel> coarser(3);
  models[0].coarser = coarser;
  CandidateList list;
  list.build({}, models, {}, false);
  EXPECT_EQ(list.levels().size(), 1u);
}

TEST(CandidateList, starts_a_new_group_where_one_call_can_take_no_more) {
  const std::vector<MeshDraw> models(CandidateList::kGroupCapacity + 5, model(1, 0, 0));
  CandidateList list;
  list.build({}, models, {}, false);
  ASSERT_EQ(list.groups().size(), 2u);
  EXPECT_EQ(list.groups()[0].capacity, CandidateList::kGroupCapacity);
  EXPECT_EQ(list.groups()[1].capacity, 5u);
  EXPECT_EQ(list.groups()[1].first_command, CandidateList::kGroupCapacity);
  list.build({}, std::span(models).first(2), {}, false);
  EXPECT_EQ(list.groups().size(), 1u) << "nothing is left of the frame before";
}

}  // namespace
}  // namespace psygen::render
