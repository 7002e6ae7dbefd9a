#include "engine/scene/draws/shown_nodes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace psygen::scene {
namespace {

// A root of level 2 with two children of level 1, of which the second has two blocks.
View view_of_five_nodes() {
  View view;
  view.cut.nodes.resize(5);
  const std::uint8_t levels[] = {2, 1, 1, 0, 0};
  const std::uint32_t parents[] = {visibility::kNoNode, 0, 0, 2, 2};
  const std::uint32_t ends[] = {5, 2, 5, 4, 5};
  const float distances_m[] = {3, 40, 3, 3, 4};
  for (std::uint32_t i = 0; i < 5; ++i) {
    visibility::CutNode& node = view.cut.nodes[i];
    node.node.level = levels[i];
    node.parent = parents[i];
    node.end = ends[i];
    node.leaf = i == 1 || i > 2;
    node.distance_m = distances_m[i];
  }
  view.in_view.assign(5, 1);
  view.ready.assign(5, 0);
  return view;
}

struct Entities {
  ecs::World world;
  DrawLists draws;
  Entities() {
    const auto made = world.create<MeshDemand>(5).entities;
    draws.entities.assign(made.begin(), made.end());
  }
  void draw(std::size_t node) { world.get<MeshDemand>(draws.entities[node])->drawn_level = 0; }
};

using NodeIndices = std::vector<std::uint32_t>;
using Flags = std::vector<std::uint8_t>;

TEST(ShownNodes, AreReadyWithAMeshIfTheyWereReadyOrNoAncestorIs) {
  View view = view_of_five_nodes();
  Entities entities;
  for (const std::size_t node : {0, 1, 3})
    entities.draw(node);
  view.ready = {1, 1, 1, 0, 0};
  find_ready(view, RenderQuery(entities.world), entities.draws);
  // QuadtreeNode 2 was evicted since; node 3 has come since, below the root.
  EXPECT_EQ(entities.draws.ready, (Flags{1, 1, 0, 0, 0}));
  view.ready = {0, 0, 0, 0, 0};
  entities.world.get<MeshDemand>(entities.draws.entities[0])->drawn_level = kNoLevel;
  find_ready(view, RenderQuery(entities.world), entities.draws);
  EXPECT_EQ(entities.draws.ready, (Flags{0, 1, 0, 1, 0}));
}

TEST(ShownNodes, DestroyedEntitiesAreNotReady) {
  View view = view_of_five_nodes();
  Entities entities;
  entities.draw(0);
  entities.world.destroy(std::span(&entities.draws.entities[0], 1));
  view.ready.assign(5, 1);
  find_ready(view, RenderQuery(entities.world), entities.draws);
  EXPECT_EQ(entities.draws.ready, Flags(5, 0));
}

TEST(ShownNodes, AreDrawnNodesAndLeavesWithoutAReplacement) {
  View view = view_of_five_nodes();
  DrawLists draws;
  draws.nodes = {0};
  list_shown(view, draws);
  EXPECT_EQ(draws.shown, (NodeIndices{0}));
  draws.nodes = {3};
  list_shown(view, draws);
  EXPECT_EQ(draws.shown, (NodeIndices{1, 3, 4}));
  EXPECT_EQ(draws.shown_nodes.size(), 3u);
  view.in_view[1] = 0;
  list_shown(view, draws);
  EXPECT_EQ(draws.shown, (NodeIndices{3, 4}));
}

TEST(ShownNodes, AreCoarserByTheLevelsToTheFinestNodeInView) {
  View view = view_of_five_nodes();
  EXPECT_EQ(coarser_by(view, 0), 2u);
  EXPECT_EQ(coarser_by(view, 1), 0u);
  view.in_view[3] = view.in_view[4] = 0;
  EXPECT_EQ(coarser_by(view, 0), 1u);
}

TEST(ShownNodes, LeavesAreAsWantedUnlessTheirFinestMeshIsMissing) {
  visibility::CutNode node;
  EXPECT_EQ(min_distance_m(node, 1, 100), 0);
  node.fine = true;
  EXPECT_EQ(min_distance_m(node, 0, 100), 0);
  EXPECT_EQ(min_distance_m(node, 1, 100), 50);
  node.leaf = node.fine = false;
  EXPECT_EQ(min_distance_m(node, 0, 100), 50);
}

TEST(ShownNodes, AreAsNearAsTheirNearestLeafInView) {
  View view = view_of_five_nodes();
  EXPECT_FLOAT_EQ(nearest_m(view, 0, 10), 3);
  EXPECT_FLOAT_EQ(nearest_m(view, 0, -4), 5);
  view.in_view[3] = 0;
  EXPECT_FLOAT_EQ(nearest_m(view, 0, 0), 4);
  view.in_view[4] = view.in_view[1] = 0;
  EXPECT_TRUE(std::isinf(nearest_m(view, 0, 0)));
}

}  // namespace
}  // namespace psygen::scene
