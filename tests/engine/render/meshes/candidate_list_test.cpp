#include "engine/render/meshes/candidate_list.hpp"

#include <gtest/gtest.h>

namespace psygen::render {
namespace {

MeshDraw candidate(std::uint32_t id, std::uint32_t block, std::uint32_t shared) {
  MeshDraw draw;
  draw.range.id = id;
  draw.range.pool_block = block;
  draw.range.first_vertex = 10 * id;
  draw.range.first_index = 100 * id;
  draw.range.index_count = 6;
  draw.shared_indices = shared;
  return draw;
}

TEST(CandidateList, GathersDrawsOfTheSameBuffersInGroupsWithRoomForAll) {
  const std::vector<IndexList> lists{{7, 9}};
  std::vector<MeshDraw> models{candidate(1, 0, 0), candidate(2, 1, 0), candidate(3, 0, 1),
                               candidate(4, 0, 0)};
  std::vector<TerrainDraw> terrain(1);
  terrain[0].range.layout = core::VertexLayout::kTerrain;
  terrain[0].shared_indices = 1;
  CandidateList list;
  list.build({.shared = lists}, terrain, models);
  ASSERT_EQ(list.candidates().size(), 5u);
  ASSERT_EQ(list.groups().size(), 4u);
  EXPECT_EQ(list.groups()[0].layout, core::VertexLayout::kTerrain);
  EXPECT_EQ(list.groups()[1].capacity, 2u);
  EXPECT_EQ(list.groups()[2].capacity, 1u);
  EXPECT_EQ(list.groups()[2].pool_block, 1u);
  EXPECT_TRUE(list.groups()[3].shared);
  EXPECT_EQ(list.command_count(), 5u);
  EXPECT_EQ(std::vector<std::uint32_t>(list.first_commands().begin(), list.first_commands().end()),
            (std::vector<std::uint32_t>{0, 1, 3, 4}));
  EXPECT_EQ(list.candidates()[3].draw, glm::uvec4(7, 9, 30, 3)) << "the shared list's indices";
  EXPECT_EQ(list.candidates()[4].draw, glm::uvec4(400, 6, 40, 1));
  EXPECT_EQ(list.candidates()[4].name.x, 5u);
  EXPECT_EQ(list.name_count(), 6u);
}

TEST(CandidateList, TakesPartsOfAMeshAsCandidatesOfOneName) {
  std::vector<MeshDraw> models{candidate(4, 0, 0), candidate(4, 0, 0)};
  models[0].range.index_count = models[1].range.index_count = 30;
  models[0].part = {0, 6};
  models[1].part = {12, 9};
  CandidateList list;
  list.build({}, {}, models);
  ASSERT_EQ(list.candidates().size(), 2u);
  EXPECT_EQ(list.candidates()[0].draw, glm::uvec4(400, 6, 40, 0));
  EXPECT_EQ(list.candidates()[1].draw, glm::uvec4(412, 9, 40, 0));
  EXPECT_EQ(list.candidates()[0].name.x, list.candidates()[1].name.x);
}

TEST(CandidateList, GroupsDrawsWithTheSamePipelineAndBuffers) {
  std::vector<MeshDraw> models(4, candidate(1, 0, 0));
  models[1].range.pool_block = 1;
  models[2].near = models[3].near = true;
  models[3].fade = 0.5F;
  CandidateList list;
  list.build({}, {}, models);
  ASSERT_EQ(list.groups().size(), 3u);
  EXPECT_EQ(list.groups()[1].coverage, Coverage::kWhole);
  EXPECT_EQ(list.groups()[2].coverage, Coverage::kNear);
  EXPECT_EQ(list.groups()[2].capacity, 2u);
}

TEST(CandidateList, StartsANewGroupWhereOneCallCanTakeNoMore) {
  const std::vector<MeshDraw> models(CandidateList::kGroupCapacity + 5, candidate(1, 0, 0));
  CandidateList list;
  list.build({}, {}, models);
  ASSERT_EQ(list.groups().size(), 2u);
  EXPECT_EQ(list.groups()[0].capacity, CandidateList::kGroupCapacity);
  EXPECT_EQ(list.groups()[1].capacity, 5u);
  EXPECT_EQ(list.groups()[1].first_command, CandidateList::kGroupCapacity);
  list.build({}, {}, std::span(models).first(2));
  EXPECT_EQ(list.groups().size(), 1u) << "nothing is left of the frame before";
}

}  // namespace
}  // namespace psygen::render
