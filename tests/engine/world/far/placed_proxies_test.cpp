#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "engine/models/kit/packing.hpp"
#include "engine/world/far/merged_models.hpp"
#include "engine/world/far/merged_plan.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/world/edits/edited_world.hpp"

namespace psygen::world {
namespace {

using models::test::Mesh;
using models::test::synthesise;

class FarEdits : public ::testing::Test, protected testing::EditedWorld {
 protected:
  std::unique_ptr<models::ModelType> type =
      make_merged_type(std::make_shared<const World>(function), registry);

  Mesh mesh(core::BlockCoord node, int level) {
    apply();
    return synthesise(*type, merged_parameters(world, node, level), 0);
  }
  // The mesh's vertices near a point of the node, in metres.
  std::size_t vertices_near(const Mesh& mesh, core::BlockCoord node, int level, glm::vec2 at) {
    const core::Bounds box = type->bounds(merged_parameters(world, node, level));
    std::set<std::size_t> used;
    std::size_t near = 0;
    for (const std::uint16_t i : mesh.indices)
      used.insert(i);
    const auto vertices = mesh.vertices<core::ModelVertex>();
    for (const std::size_t i : used) {
      const glm::vec3 p = models::unpack_position(vertices[i], box);
      near += std::abs(p.x - at.x) < 0.6F && std::abs(p.z - at.y) < 0.6F;
    }
    return near;
  }
  PlacedPlan plan_of(core::BlockCoord node, std::uint32_t level, std::uint64_t beside) {
    TypesByName types;
    for (models::ModelIndex i = 0; i < registry.size(); ++i)
      types.emplace(registry[i].name(), &registry[i]);
    const models::EditLayer* const layers[] = {world.layer().get(), nullptr};
    return {world, types, layers, models::QuadCoord::of(node, level), static_cast<int>(level),
            beside};
  }
  // A tree of block (4, 4) with no other model that near.
  Placement lonely_tree() {
    const std::vector<Placement> all = unedited({4, 4});
    for (const Placement& tree : all) {
      if (registry[tree.model].name() != "tree") continue;
      const bool lonely = std::ranges::none_of(all, [&](const Placement& other) {
        return other.index != tree.index &&
               glm::length(glm::vec2(other.position.x - tree.position.x,
                                     other.position.z - tree.position.z)) < 8;
      });
      if (lonely) return tree;
    }
    ADD_FAILURE() << "there is no lonely tree";
    return all[0];
  }
};

TEST_F(FarEdits, AFelledTreeIsMissingFromAllMeshesThatShowIt) {
  const Placement tree = lonely_tree();
  const Mesh before = mesh({2, 2}, 1);
  const glm::vec2 at(tree.position.x, tree.position.z);
  EXPECT_GT(vertices_near(before, {2, 2}, 1, at), 0u);
  ASSERT_TRUE(edits.remove(world, {{4, 4}, tree.index}));
  const Mesh after = mesh({2, 2}, 1);
  EXPECT_EQ(vertices_near(after, {2, 2}, 1, at), 0u);
  for (int level = 2; level <= kMaxMergedLevel; ++level) {
    const core::BlockCoord node{4 >> level, 4 >> level};
    EXPECT_NE(merged_parameters(world, node, level).hash(), merged_parameters(node, level).hash());
  }
  EXPECT_EQ(merged_parameters(world, {3, 2}, 1).hash(), merged_parameters({3, 2}, 1).hash());
}

TEST_F(FarEdits, FellingTheSameTreeOfANeighbouringBlockGivesAnotherMesh) {
  World beside = world;
  Edits other;
  ASSERT_TRUE(edits.remove(world, {{12, 7}, 3}));
  ASSERT_TRUE(other.remove(world, {{13, 7}, 3}));
  apply();
  set_edits(beside, other.layer());
  for (int level = 1; level <= kMaxMergedLevel; ++level) {
    const core::BlockCoord node{12 >> level, 7 >> level};
    EXPECT_NE(merged_parameters(world, node, level).hash(),
              merged_parameters(beside, node, level).hash());
  }
}

TEST_F(FarEdits, FellingEverythingLeavesNothingAtAnyLevel) {
  for (int z = 0; z < 4; ++z) {
    for (int x = 0; x < 4; ++x) {
      for (const Placement& p : unedited({x, z}))
        ASSERT_TRUE(edits.remove(world, {{x, z}, p.index}));
    }
  }
  for (const int level : {1, 2}) {
    const Mesh felled = mesh({0, 0}, level);
    EXPECT_TRUE(std::ranges::all_of(felled.indices, [](std::uint16_t i) { return i == 0; }));
  }
}

TEST_F(FarEdits, APlacedTreeIsInTheMeshesOfItsNodesAndInsideTheirBox) {
  Placement tree = lonely_tree();
  const core::WorldPosition place{{5, 5}, {1, 0, 1}};
  const auto placed = edits.place(world, registry, {tree.model, tree.parameters, place, 0});
  ASSERT_TRUE(placed);
  const std::size_t unedited_near =
      vertices_near(synthesise(*type, merged_parameters({2, 2}, 1), 0), {2, 2}, 1, {64, 64});
  EXPECT_GT(vertices_near(mesh({2, 2}, 1), {2, 2}, 1, {64, 64}), unedited_near);
  for (int level = 1; level <= kMaxMergedLevel; ++level) {
    const models::Parameters p = merged_parameters(world, {4 >> level, 4 >> level}, level);
    for (const int detail : {0, 1}) {
      const Mesh made = synthesise(*type, p, detail);
      EXPECT_EQ(made.size, type->mesh_size(p, detail));
    }
  }
}

TEST_F(FarEdits, ManyPlacedModelsShareForms) {
  const Scatter& scatter = world.scatter[0];
  NewModel model{scatter.model, scatter_parameters(registry, scatter), {}, 0};
  for (int i = 0; i < 3000; ++i) {
    model.at = {{i % 4, i / 4 % 4}, {i % 61 + 0.5, 0, i % 59 + 0.5}};
    ASSERT_TRUE(edits.place(world, registry, model));
  }
  apply();
  const models::Parameters p = merged_parameters(world, {0, 0}, 2);
  const Mesh made = synthesise(*type, p, 0);
  EXPECT_LE(made.size.vertex_count, 65'536u);
  const PlacedPlan plan = plan_of({0, 0}, 2, 0);
  EXPECT_EQ(plan.together, 2u);
  EXPECT_EQ(plan.shared_from, 1024u);
  EXPECT_EQ(plan.forms.size(), 1024u + 988u);
  EXPECT_TRUE(plan_of({0, 0}, 2, 65'536).forms.empty());
  EXPECT_EQ(plan_of({9, 9}, 1, 0).vertices, 0u);
}

// The silhouette of a node with one placed rock, beside that of the rock.
TEST_F(FarEdits, APlacedModelKeepsItsSilhouetteUntilItIsSmallerThanTheError) {
  const models::ModelIndex rock = world.scatter[1].model;
  models::Parameters big = models::default_parameters(registry[rock]);
  big.set_real(static_cast<std::size_t>(models::parameter_index(registry[rock], "radius_m")), 8);
  for (const bool by_file : {false, true}) {
    World bare = function;
    bare.scatter.clear();
    Edits one;
    if (by_file) {
      bare.places.all = {{rock, big, {330, 330}, 0}};
      sort_places(bare, registry);
    } else {
      ASSERT_TRUE(one.place(bare, registry, {rock, big, {{5, 5}, {15, 0, 15}}, 0}));
    }
    const auto merged = make_merged_type(std::make_shared<const World>(bare), registry);
    if (!by_file) set_edits(bare, one.layer());
    SampleMesh finest, seen;
    finest.make(registry[rock], big, 0);
    const float expected_m2 = finest.silhouette(registry[rock]).plan_m2;
    for (int level = 1; level <= 8; ++level) {
      const core::BlockCoord node{5 >> level, 5 >> level};
      const models::Parameters p = merged_parameters(bare, node, level);
      const float size_m = registry[rock].bounds(big).max.y - registry[rock].bounds(big).min.y;
      const bool large = form_error_m(bare, level) < static_cast<double>(size_m) / 3;
      seen.make(*merged, p, 0);
      EXPECT_TRUE(!large || has_placed(bare, node, level));
      EXPECT_GE(placed_error_m(bare, level) + 1e-6, std::min(form_error_m(bare, level), 8.0));
      if (large) {
        EXPECT_NEAR(seen.silhouette(*merged).plan_m2, expected_m2, 0.3F * expected_m2);
      }
      if (form_error_m(bare, level) > 60) {
        EXPECT_LT(seen.silhouette(*merged).plan_m2, 1);
      }
      EXPECT_FALSE(has_placed(bare, {node.x + 1, node.z}, level));
    }
    EXPECT_FALSE(scattered_bounds(*merged, 1));
  }
  EXPECT_EQ(placed_error_m(function, 1), 0);
}

TEST_F(FarEdits, MergedModelsStandOnTheEditedGround) {
  const Placement tree = lonely_tree();
  ASSERT_TRUE(edits.raise(world, {{4, 4}, {tree.position.x, 0, tree.position.z}}, 30, 40));
  const core::Bounds box = type->bounds(merged_parameters({2, 2}, 1));
  const auto lowest_near = [&](const Mesh& m) {
    float lowest = 1e9F;
    const auto vertices = m.vertices<core::ModelVertex>();
    for (const std::uint16_t i : m.indices) {
      const glm::vec3 p = models::unpack_position(vertices[i], box);
      if (glm::length(glm::vec2(p.x - tree.position.x, p.z - tree.position.z)) < 3)
        lowest = std::min(lowest, p.y);
    }
    return lowest;
  };
  const float before = lowest_near(synthesise(*type, merged_parameters({2, 2}, 1), 0));
  EXPECT_NEAR(lowest_near(mesh({2, 2}, 1)) - before, 40, 4);
}

}  // namespace
}  // namespace psygen::world
