#include "engine/scene/meshes/mesh_choice.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace psygen::scene {
namespace {

using synthesis::Rank;
using synthesis::RankGroup;

constexpr float kNever = std::numeric_limits<float>::infinity();

LodErrors four_levels() {
  LodErrors detail;
  detail.error_m = {0, 0.1F, 0.4F, 1.6F};
  detail.level_count = 4;
  return detail;
}

NodeView in_view() {
  NodeView node;
  node.wanted = node.in_view = node.leaf = true;
  return node;
}

MeshDemand demand(std::uint8_t drawn, std::uint8_t wanted) {
  MeshDemand made;
  made.drawn_level = drawn;
  made.wanted_level = wanted;
  return made;
}

TEST(MeshChoice, GroundIsFineNearTheCameraAndKeepsItsMeshOutOfView) {
  NodeView node;
  EXPECT_EQ(ground_level(node, four_levels(), kNoLevel), 3);
  EXPECT_EQ(ground_level(node, four_levels(), 1), 1);
  node.wanted = true;
  EXPECT_EQ(ground_level(node, four_levels(), 1), 3);
  node.fine = true;
  EXPECT_EQ(ground_level(node, four_levels(), 1), 0);
}

TEST(MeshChoice, ModelsGetCoarserWithDistanceUntilTheyAreTooSmall) {
  ChoiceRules rules;
  rules.pixels_per_radian = 1000;
  rules.min_size_pixels = 2;
  const NodeView node;
  int last = 0;
  for (const float distance_m : {1.0F, 150.0F, 600.0F, 1700.0F}) {
    const int level = model_level(rules, node, four_levels(), 2, distance_m, kNoLevel);
    EXPECT_EQ(level, last++);
  }
  EXPECT_EQ(model_level(rules, node, four_levels(), 1.9F, 1700, kNoLevel), kNoLevel);
  rules.levels_of_detail = false;
  EXPECT_EQ(model_level(rules, node, four_levels(), 2, 1700, kNoLevel), 0);
}

// An approaching tree never gets coarser, whatever its mesh, and it does not flicker.
TEST(MeshChoice, NearTreesAreCoarserIfLeafTexturesHideIt) {
  ChoiceRules rules;
  rules.pixels_per_radian = 1000;
  LodErrors tree = four_levels();
  tree.leaves = true;
  tree.error_m = {0, 0.03F, 0.06F, 1.6F};
  LodErrors rock = tree;
  rock.leaves = false;
  const auto level = [&](const LodErrors& of, float distance_m) {
    return model_level(rules, in_view(), of, 100, distance_m, kNoLevel);
  };
  EXPECT_EQ(level(tree, 20), 0);
  EXPECT_EQ(level(tree, 40), 1);
  rules.near_leaves_m = 64;
  EXPECT_EQ(level(tree, 20), 1);
  EXPECT_EQ(level(tree, 40), 2);
  EXPECT_EQ(level(tree, 70), 2);
  EXPECT_EQ(level(rock, 20), 0);
  NodeView merged = in_view();
  merged.level = 1;
  EXPECT_EQ(model_level(rules, merged, tree, 100, 20, kNoLevel), 0);
  for (const std::uint8_t drawn : {kNoLevel, std::uint8_t{0}, std::uint8_t{1}, std::uint8_t{2}}) {
    int last = 0;
    for (float distance_m = 0; distance_m < 100; distance_m += 0.25F) {
      const int now = model_level(rules, in_view(), tree, 100, distance_m, drawn);
      EXPECT_GE(now, last) << distance_m;
      last = now;
    }
    EXPECT_EQ(last, 2);
  }
}

TEST(MeshChoice, NearTreesAreNoImpostorsBeforeTheirErrorAllowsIt) {
  ChoiceRules rules;
  rules.pixels_per_radian = 1000;
  rules.near_leaves_m = 64;
  LodErrors tree = four_levels();
  tree.leaves = true;
  tree.error_m = {0, 0.01F, 0.02F, 0.05F};
  tree.picture_level = 3;
  EXPECT_EQ(model_level(rules, in_view(), tree, 100, 30, kNoLevel), 2);
  EXPECT_EQ(model_level(rules, in_view(), tree, 100, 60, kNoLevel), 3);
}

TEST(MeshChoice, MergedModelsAreNeverTooSmall) {
  ChoiceRules rules;
  rules.pixels_per_radian = 1000;
  rules.min_size_pixels = 2;
  NodeView node;
  node.level = 1;
  EXPECT_EQ(model_level(rules, node, four_levels(), 0.1F, 1e6F, kNoLevel), 3);
}

// As above, with an impostor as the last level.
LodErrors pictured() {
  LodErrors detail = four_levels();
  detail.picture_level = 3;
  return detail;
}

TEST(MeshChoice, AModelTooLargeForAnImpostorIsAMesh) {
  ChoiceRules rules;
  rules.pixels_per_radian = 1000;
  const NodeView node;
  const float small = kMaxPicturePixels - 1, large = kMaxPicturePixels + 1;
  EXPECT_EQ(model_level(rules, node, pictured(), small, 1700, kNoLevel), 3);
  EXPECT_EQ(model_level(rules, node, pictured(), large, 1700, kNoLevel), 2);
  // A drawn impostor stays up to a limit.
  EXPECT_EQ(model_level(rules, node, pictured(), large, 1700, 3), 3);
  EXPECT_EQ(model_level(rules, node, pictured(), 1.2F * large, 1700, 3), 2);
  EXPECT_EQ(model_level(rules, node, pictured(), large, 150, kNoLevel), 1);
}

TEST(MeshChoice, HysteresisHoldsUnlessTheSceneSettles) {
  ChoiceRules rules;
  rules.pixels_per_radian = 1000;
  const NodeView node;
  EXPECT_EQ(model_level(rules, node, four_levels(), 50, 110, kNoLevel), 1);
  EXPECT_EQ(model_level(rules, node, four_levels(), 50, 110, 0), 0);
  rules.settle = true;
  EXPECT_EQ(model_level(rules, node, four_levels(), 50, 110, 0), 1);
}

TEST(MeshChoice, OutOfViewTheNextLevelIsEnoughUnlessTheModelIsExpected) {
  LodErrors detail = four_levels();
  EXPECT_EQ(level_out_of_view(detail, 1, false, kNoLevel), 2);
  EXPECT_EQ(level_out_of_view(detail, 1, false, 3), 2);
  EXPECT_EQ(level_out_of_view(detail, 1, true, kNoLevel), 1);
  EXPECT_EQ(level_out_of_view(detail, 1, true, 2), 1);
  for (const bool expected : {true, false}) {
    EXPECT_EQ(level_out_of_view(detail, 1, expected, 1), 1);
    EXPECT_EQ(level_out_of_view(detail, 1, expected, 0), 0);
    EXPECT_EQ(level_out_of_view(detail, 3, expected, kNoLevel), 3) << "none is coarser";
    EXPECT_EQ(level_out_of_view(detail, kNoLevel, expected, 0), kNoLevel) << "too small";
  }
  detail.picture_level = 3;
  EXPECT_EQ(level_out_of_view(detail, 2, false, kNoLevel), 2) << "a picture does not do for it";
}

TEST(MeshChoice, AHoleRequestsTheCoarsestLevelUnlessTheWantedOneIsCached) {
  const MeshDemand hole = demand(kNoLevel, 1);
  EXPECT_EQ(choose_mesh({}, in_view(), four_levels(), hole, {}).request, 3);
  EXPECT_EQ(choose_mesh({}, in_view(), four_levels(), hole, {.cached = true}).request, 1);
}

TEST(MeshChoice, AMeshDrawnAsWantedRequestsNothing) {
  const MeshChoice choice = choose_mesh({}, in_view(), four_levels(), demand(2, 2), {});
  EXPECT_TRUE(choice.there);
  EXPECT_EQ(choice.request, kNoLevel);
  EXPECT_EQ(choice.drawn, RankGroup::kDrawn);
}

TEST(MeshChoice, AHoleRequestsItsCoarsestLevelFirst) {
  ChoiceRules rules;
  const MeshDemand hole = demand(kNoLevel, 0);
  MeshChoice choice = choose_mesh(rules, in_view(), four_levels(), hole, {});
  EXPECT_EQ(choice.request, 3);
  EXPECT_EQ(choice.requested, RankGroup::kVisibleHole);
  rules.coarse_first = false;
  choice = choose_mesh(rules, in_view(), four_levels(), hole, {});
  EXPECT_EQ(choice.request, 0);
}

TEST(MeshChoice, AHoleRequestsItsWantedLevelIfItIsCached) {
  const MeshDemand hole = demand(kNoLevel, 1);
  EXPECT_EQ(choose_mesh({}, in_view(), four_levels(), hole, {.cached = true}).request, 1);
  EXPECT_EQ(choose_mesh({}, in_view(), four_levels(), hole, {}).request, 3);
}

TEST(MeshChoice, ADraftReplacesOldMeshesByCoarseOnesAndRefinesNone) {
  ChoiceRules rules;
  rules.draft = true;
  MeshDemand old = demand(0, 0);
  old.stale = true;
  EXPECT_EQ(choose_mesh(rules, in_view(), four_levels(), old, {}).request, kDraftLevels);
  const MeshDemand drafted = demand(kDraftLevels, 0);
  EXPECT_EQ(choose_mesh(rules, in_view(), four_levels(), drafted, {}).request, kNoLevel);
  EXPECT_FALSE(choose_mesh(rules, in_view(), four_levels(), drafted, {}).there);
  const MeshDemand new_one = demand(3, 0);
  EXPECT_EQ(choose_mesh(rules, in_view(), four_levels(), new_one, {}).request, kDraftLevels);
  rules.draft = false;
  EXPECT_EQ(choose_mesh(rules, in_view(), four_levels(), drafted, {}).request, 0);
}

TEST(MeshChoice, ADraftHasNoImpostorInPlaceOfAWantedMesh) {
  ChoiceRules rules;
  rules.draft = true;
  MeshDemand old = demand(1, 1);
  old.stale = true;
  EXPECT_EQ(choose_mesh(rules, in_view(), pictured(), old, {}).request, 2);
  old.wanted_level = 3;
  EXPECT_EQ(choose_mesh(rules, in_view(), pictured(), old, {}).request, 3);
  // Too fine meshes and holes are treated as usual.
  EXPECT_EQ(choose_mesh(rules, in_view(), four_levels(), demand(0, 1), {}).request, 1);
  EXPECT_EQ(choose_mesh(rules, in_view(), four_levels(), demand(kNoLevel, 1), {}).request, 3);
}

TEST(MeshChoice, HolesAreInViewAndNeitherDrawnNorCovered) {
  NodeView node = in_view();
  EXPECT_TRUE(is_hole(node, demand(kNoLevel, 1), true));
  EXPECT_FALSE(is_hole(node, demand(kNoLevel, 1), false));
  EXPECT_FALSE(is_hole(node, demand(2, 1), true));
  node.covered = true;
  EXPECT_FALSE(is_hole(node, demand(kNoLevel, 1), true));
}

TEST(MeshChoice, AHoleThatWaitsTooLongRequestsTheNextLevelUnlessItWaitsForMemory) {
  ChoiceRules rules;
  rules.real_s = 10;
  MeshDemand hole = demand(kNoLevel, 0);
  hole.seen_s = 9.99F;
  const auto request = [&] {
    return choose_mesh(rules, in_view(), four_levels(), hole, {}).request;
  };
  EXPECT_EQ(request(), 3);
  hole.seen_s = 9.9F;
  EXPECT_EQ(request(), 2);
  rules.awaits_memory = true;
  EXPECT_EQ(request(), 3);
  rules.awaits_memory = false;
  rules.short_of_memory = true;
  EXPECT_EQ(request(), 3);
}

TEST(MeshChoice, AMeshCoveredByAnAncestorIsNoHole) {
  NodeView node = in_view();
  node.covered = true;
  const MeshChoice choice = choose_mesh({}, node, four_levels(), demand(kNoLevel, 1), {});
  EXPECT_EQ(choice.request, 1);
  EXPECT_EQ(choice.requested, RankGroup::kVisibleCoarse);
}

TEST(MeshChoice, ALevelThatFailedIsReplacedByTheNearestOne) {
  MeshDemand failed = demand(kNoLevel, 1);
  failed.failed_levels = 0b0010;
  NodeView node = in_view();
  node.covered = true;
  EXPECT_EQ(choose_mesh({}, node, four_levels(), failed, {}).request, 2);
  failed.failed_levels = 0b1110;
  EXPECT_EQ(choose_mesh({}, node, four_levels(), failed, {}).request, 0);
  failed.failed_levels = 0b1111;
  EXPECT_EQ(choose_mesh({}, node, four_levels(), failed, {}).request, kNoLevel);
}

TEST(MeshChoice, TooFineModelsAreEvictedAndGroundIsNot) {
  ChoiceRules rules;
  const MeshDemand fine = demand(0, 2);
  EXPECT_EQ(choose_mesh(rules, in_view(), four_levels(), fine, {}).drawn, RankGroup::kVisibleFine);
  EXPECT_EQ(choose_mesh(rules, in_view(), four_levels(), fine, {}).requested,
            RankGroup::kVisibleCoarse);
  rules.short_of_memory = true;
  EXPECT_EQ(choose_mesh(rules, in_view(), four_levels(), fine, {}).requested,
            RankGroup::kVisibleFine);
  EXPECT_EQ(choose_mesh(rules, in_view(), four_levels(), fine, {.is_ground = true}).drawn,
            RankGroup::kDrawn);
}

TEST(MeshChoice, NewLightOnGroundWaitsForMissingDetail) {
  MeshDemand stale = demand(3, 3);
  stale.stale = true;
  const MeshChoice choice = choose_mesh({}, in_view(), four_levels(), stale, {.is_ground = true});
  EXPECT_FALSE(choice.there);
  EXPECT_EQ(choice.request, 3);
  EXPECT_EQ(choice.requested, RankGroup::kDrawn);
}

TEST(MeshChoice, OnlyHolesInTheCoarsestGroundAreRequestedFirst) {
  ChoiceRules rules;
  rules.node_levels = 4;
  NodeView node = in_view();
  node.level = 3;
  const MeshDemand hole = demand(kNoLevel, 3);
  EXPECT_TRUE(choose_mesh(rules, node, four_levels(), hole, {.is_ground = true}).at_once);
  EXPECT_FALSE(choose_mesh(rules, node, four_levels(), hole, {}).at_once);
  node.level = 2;
  EXPECT_FALSE(choose_mesh(rules, node, four_levels(), hole, {.is_ground = true}).at_once);
}

TEST(MeshChoice, RanksOrderHolesByLevelAndMeshesOutOfViewByDeadline) {
  NodeView coarse = in_view(), fine = in_view();
  coarse.level = 3;
  coarse.visibility.layer = 9;
  EXPECT_LT(rank_on(coarse, RankGroup::kVisibleHole, 50),
            rank_on(fine, RankGroup::kVisibleHole, 5));
  NodeView expected, around;
  expected.visibility.deadline_s = 2;
  around.visibility.deadline_s = kNever;
  EXPECT_EQ(rank_on(expected, RankGroup::kPrefetch, 5), Rank::by_deadline(2, 5));
  EXPECT_EQ(rank_on(around, RankGroup::kPrefetch, 5), Rank::by_layer(RankGroup::kPrefetch, 0, 5));
  EXPECT_EQ(rank_on(around, RankGroup::kUnwanted, 5), Rank::unwanted());
}

}  // namespace
}  // namespace psygen::scene
