#include "engine/visibility/quadtree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "tests/engine/visibility/scenes.hpp"

namespace psygen::visibility {
namespace {

using testing::kBlock_m;
using testing::stream;

std::int64_t steps(std::int32_t to, std::int32_t from) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(to) -
                                   static_cast<std::uint32_t>(from));
}

std::vector<LevelDistances> distances(std::size_t count, double first_error_m = 0.3,
                                      double growth = 2, double merge_factor = 1.1) {
  std::vector<double> errors;
  for (double error = first_error_m; errors.size() < count; error *= growth)
    errors.push_back(error);
  std::vector<LevelDistances> levels(count);
  split_distances(errors, {.pixels_per_radian = 745, .merge_factor = merge_factor}, levels);
  return levels;
}

// Roots of a level around a camera, and the other inputs of a selection.
struct Scene {
  std::vector<LevelDistances> levels;
  std::vector<NodeCoord> roots;
  CutInput input;

  Scene(const core::WorldPosition& camera, std::uint8_t root_level, double view_m,
        std::vector<LevelDistances> level_distances)
      : levels(std::move(level_distances)) {
    roots_around(camera, kBlock_m, view_m, root_level, roots);
    input.camera = camera;
    input.roots = roots;
    input.levels = levels;
  }
};

// Every block of the roots' area with the level of its leaf, −1 if that is fine.
using BlockLevels = std::map<std::pair<std::int64_t, std::int64_t>, int>;

BlockLevels raster(const Cut& cut, core::BlockCoord origin) {
  BlockLevels blocks;
  for (const CutNode& node : cut.nodes) {
    if (!node.leaf) continue;
    const core::BlockCoord corner = corner_block(node.node);
    for (std::int64_t z = 0; z < 1 << node.node.level; ++z) {
      for (std::int64_t x = 0; x < 1 << node.node.level; ++x) {
        const bool first =
            blocks
                .emplace(std::pair(steps(corner.x, origin.x) + x, steps(corner.z, origin.z) + z),
                         node.fine ? -1 : node.node.level)
                .second;
        EXPECT_TRUE(first) << "two leaves cover one block";
      }
    }
  }
  return blocks;
}

void expect_restricted(const BlockLevels& blocks) {
  for (const auto& [place, level] : blocks) {
    for (const auto& [dx, dz] : {std::pair{1, 0}, {0, 1}, {1, 1}, {1, -1}}) {
      const auto other = blocks.find({place.first + dx, place.second + dz});
      if (other == blocks.end()) continue;
      ASSERT_LE(std::abs(other->second - level), 2) << place.first << ' ' << place.second;
    }
  }
}

core::WorldPosition random_camera(core::RandomStream& random, std::int64_t reach) {
  return {{static_cast<std::int32_t>(random.next_integer(-reach, reach)),
           static_cast<std::int32_t>(random.next_integer(-reach, reach))},
          {random.next_real(0, kBlock_m), 30, random.next_real(0, kBlock_m)}};
}

TEST(NodeCoord, ChildrenKnowTheirParentAndTileIt) {
  core::RandomStream random = stream(41, 0);
  for (int i = 0; i < 200; ++i) {
    const core::BlockCoord block{static_cast<std::int32_t>(random.next_u64()),
                                 static_cast<std::int32_t>(random.next_u64())};
    const auto level = static_cast<std::uint8_t>(random.next_integer(1, kMaxNodeLevel));
    const NodeCoord node = node_of(block, level);
    const core::BlockCoord corner = corner_block(node);
    EXPECT_EQ(node_of(corner, level), node);
    EXPECT_GE(block.x, corner.x);
    EXPECT_LT(steps(block.x, corner.x), std::int64_t{1} << level);
    for (unsigned c = 0; c < 4; ++c) {
      const NodeCoord child = child_of(node, c);
      EXPECT_EQ(parent_of(child), node);
      const std::int64_t half = std::int64_t{1} << (level - 1);
      EXPECT_EQ(steps(corner_block(child).x, corner.x), (c & 1U) != 0 ? half : 0);
      EXPECT_EQ(steps(corner_block(child).z, corner.z), (c & 2U) != 0 ? half : 0);
    }
  }
}

TEST(NodeCoord, NeighboursAcrossTheSeamAreCanonical) {
  const NodeCoord last = node_of({INT32_MAX, INT32_MIN}, 5);
  const NodeCoord next = neighbour_of(last, 1, -1);
  EXPECT_EQ(next, node_of({INT32_MIN, INT32_MAX}, 5));
  EXPECT_EQ(neighbour_of(next, -1, 1), last);
  EXPECT_EQ(corner_block(next).x, INT32_MIN);
}

TEST(SplitDistances, FollowTheErrorTheRatioAndTheLevelsBelow) {
  std::vector<LevelDistances> levels(4);
  const SplitSettings settings{.block_size_m = 64,
                               .pixels_per_radian = 1000,
                               .max_error_pixels = 2,
                               .min_ratio = 1.5,
                               .merge_factor = 1.25,
                               .morph_share = 0.5};
  split_distances(std::vector{0.1, 2.0, 2.0, 2.0}, settings, levels);
  EXPECT_DOUBLE_EQ(levels[0].split_m, 96);  // the ratio; the error would give 50
  EXPECT_DOUBLE_EQ(levels[0].merge_m, 120);
  EXPECT_DOUBLE_EQ(levels[0].morph_m, 48);
  EXPECT_DOUBLE_EQ(levels[1].split_m, 1000);
  EXPECT_DOUBLE_EQ(levels[1].morph_m, 500);
  EXPECT_NEAR(levels[2].split_m, 2500, 1e-3);  // 1000 by its error
  EXPECT_NEAR(levels[2].morph_m, 1250, 1e-3);  // not before merge_m below, and with room
  EXPECT_NEAR(levels[3].split_m, 6250, 1e-3);
}

TEST(SplitDistances, FollowTheErrorNoFartherThanTheLargestRatio) {
  std::vector<LevelDistances> levels(2);
  const SplitSettings settings{
      .block_size_m = 63, .pixels_per_radian = 745, .max_error_pixels = 0.7, .max_ratio = 3};
  split_distances(std::vector{0.1, 1e6}, settings, levels);
  EXPECT_DOUBLE_EQ(levels[0].split_m, 0.1 * 745 / 0.7);
  EXPECT_EQ(levels[1].split_m, 3.0 * 126);  // exactly
}

TEST(SplitDistances, ReachBeyondWhatTouchesNodesTwoLevelsBelow) {
  std::vector<LevelDistances> levels(3);
  const SplitSettings settings{.block_size_m = 64, .min_ratio = 0.1, .merge_factor = 1};
  split_distances(std::vector{0.01, 0.01, 0.01}, settings, levels);
  EXPECT_DOUBLE_EQ(levels[0].split_m, 10);
  EXPECT_NEAR(levels[1].split_m, 10 / 0.7, 1e-3);
  EXPECT_NEAR(levels[2].split_m, 10 + 64 * std::sqrt(2.0), 1e-3);
}

TEST(Roots, OfAFiniteWorldReachIntoIt) {
  core::RandomStream random = stream(41, 7);
  std::size_t some = 0, none = 0, all = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto level = static_cast<std::uint8_t>(random.next_integer(0, 12));
    const auto blocks = [&random] {
      const std::int64_t most = std::int64_t{1} << random.next_integer(0, 31);
      return static_cast<std::uint32_t>(random.next_integer(0, most));
    };
    const BlockArea world{{}, blocks(), blocks()};
    // Cameras at the world's corners, at the seam of the indices, and anywhere.
    const auto index = [&](std::uint32_t count) {
      const std::int64_t places[] = {0, count, INT32_MIN, INT32_MAX,
                                     random.next_integer(INT32_MIN, INT32_MAX)};
      return static_cast<std::int32_t>(places[random.next_integer(0, 4)] +
                                       random.next_integer(-20, 20));
    };
    const core::WorldPosition camera{{index(world.blocks_x), index(world.blocks_z)}, {1, 0, 2}};
    const double view_m = kBlock_m * static_cast<double>(5 << level);
    std::vector<NodeCoord> square, roots;
    roots_around(camera, kBlock_m, view_m, level, square);
    roots_around(camera, kBlock_m, view_m, level, roots, world);
    const auto reaches = [level](std::int64_t corner, std::int64_t count) {
      return count == 0 || (corner + (std::int64_t{1} << level) > 0 && corner < count);
    };
    std::erase_if(square, [&](const NodeCoord& node) {
      const core::BlockCoord corner = corner_block(node);
      return !reaches(corner.x, world.blocks_x) || !reaches(corner.z, world.blocks_z);
    });
    ASSERT_EQ(roots, square) << world.blocks_x << " x " << world.blocks_z << " blocks, level "
                             << int{level} << ", camera " << camera.block.x << ", "
                             << camera.block.z;
    ++(roots.empty() ? none : roots.size() < 50 ? some : all);
  }
  EXPECT_GT(some, 100u);
  EXPECT_GT(none, 100u);
  EXPECT_GT(all, 50u);
}

TEST(Roots, OfATinyWorldAreFewForAnyViewDistance) {
  std::vector<NodeCoord> roots;
  roots_around({{3000, -5}, {}}, 0.03, 65536, 0, roots, {{}, 1, 1});
  EXPECT_EQ(roots, (std::vector<NodeCoord>{{{0, 0}, 0}}));
}

TEST(Cut, LeavesTileTheRootsExactlyAndDifferByTwoLevelsAtMost) {
  core::RandomStream random = stream(41, 1);
  std::set<int> levels_seen;
  for (int i = 0; i < 12; ++i) {
    const double growth = random.next_real(1, 3);
    const Scene scene(random_camera(random, 1000), 6, 10'000,
                      distances(7, random.next_real(0.001, 0.6), growth));
    Cut cut;
    select_cut(scene.input, cut);
    const BlockLevels blocks = raster(cut, scene.input.camera.block);
    EXPECT_EQ(blocks.size(), scene.roots.size() * 64 * 64);
    for (const NodeCoord& root : scene.roots) {
      const core::BlockCoord corner = corner_block(root);
      EXPECT_TRUE(blocks.contains({steps(corner.x, scene.input.camera.block.x),
                                   steps(corner.z, scene.input.camera.block.z)}));
    }
    expect_restricted(blocks);
    for (const auto& [place, level] : blocks)
      levels_seen.insert(level);
  }
  EXPECT_EQ(levels_seen, (std::set{-1, 0, 1, 2, 3, 4, 5, 6}));
}

TEST(Cut, StaysRestrictedWithHysteresisAndClearancesWhereverTheCameraMoves) {
  core::RandomStream random = stream(41, 2);
  Cut cut;
  core::WorldPosition camera{{5, -7}, {1, 2, 3}};
  for (int i = 0; i < 40; ++i) {
    const double step = i % 10 == 0 ? 20'000 : random.next_real(0, 900);
    const double turn = random.next_real(0, 6.3);
    camera.local += glm::dvec3(std::cos(turn) * step, 0, std::sin(turn) * step);
    camera = core::normalised(camera, kBlock_m);
    Scene scene(camera, 6, 5000, distances(7, 0.1, 1.6, 1.4));
    std::vector<double> clearances(7, random.next_real(0, 800));
    for (std::size_t k = 1; k < clearances.size(); ++k)
      clearances[k] = clearances[k - 1] * random.next_real(0.3, 1);
    scene.input.clearances_m = clearances;
    select_cut(scene.input, cut);
    const BlockLevels blocks = raster(cut, camera.block);
    EXPECT_EQ(blocks.size(), scene.roots.size() * 64 * 64);
    expect_restricted(blocks);
  }
}

TEST(Cut, LeavesLieWithinTheDistancesOfTheirLevel) {
  const Scene scene({{3, 4}, {10, 20, 30}}, 7, 20'000, distances(8));
  Cut cut;
  select_cut(scene.input, cut);
  for (const CutNode& node : cut.nodes) {
    const bool split = static_cast<double>(node.distance_m) < scene.levels[node.node.level].split_m;
    EXPECT_EQ(split, !node.leaf || node.fine);
    const core::Bounds box = node.box(-5, 5);
    EXPECT_NEAR(std::hypot(std::max({box.min.x, -box.max.x, 0.0F}),
                           std::max({box.min.z, -box.max.z, 0.0F})),
                node.distance_m, 0.01F);
  }
}

TEST(Cut, NodesGrowWithTheLogarithmOfTheViewDistance) {
  std::vector<std::size_t> counts;
  for (int doubling = 0; doubling < 8; ++doubling) {
    const auto level = static_cast<std::uint8_t>(4 + doubling);
    Scene scene({{3, 4}, {10, 20, 30}}, level, 2000.0 * (1 << doubling), distances(level + 1U));
    scene.input.view_distance_m = 2000.0 * (1 << doubling);
    Cut cut;
    select_cut(scene.input, cut);
    counts.push_back(cut.nodes.size());
  }
  for (std::size_t i = 1; i < counts.size(); ++i) {
    // Each doubling adds the same number, although the area quadruples.
    EXPECT_NEAR(static_cast<double>(counts[i] - counts[i - 1]), 210, 15) << i;
  }
}

TEST(Cut, IsTheSameAcrossTheSeamOfTheBlockIndices) {
  const core::WorldPosition here{{1, -1}, {10, 20, 30}},
      seam{{INT32_MIN + 1, INT32_MAX}, {10, 20, 30}};
  const Scene a(here, 8, 30'000, distances(9)), b(seam, 8, 30'000, distances(9));
  Cut cut_a, cut_b;
  select_cut(a.input, cut_a);
  select_cut(b.input, cut_b);
  ASSERT_EQ(cut_a.nodes.size(), cut_b.nodes.size());
  std::map<std::pair<float, float>, float> places_a, places_b;
  for (std::size_t i = 0; i < cut_a.nodes.size(); ++i) {
    const CutNode &na = cut_a.nodes[i], &nb = cut_b.nodes[i];
    if (na.leaf) places_a[{na.corner_x_m, na.corner_z_m}] = na.side_m;
    if (nb.leaf) places_b[{nb.corner_x_m, nb.corner_z_m}] = nb.side_m;
    EXPECT_EQ(node_of(corner_block(nb.node), nb.node.level), nb.node);  // canonical
  }
  EXPECT_EQ(places_a, places_b);
  expect_restricted(raster(cut_b, seam.block));
}

// Distance at which a half-line from the camera enters a node's square; negative if it does not.
double entry(const CutNode& node, double dx, double dz) {
  const auto slab = [](double low, double high, double d) {
    return std::pair(std::min(low / d, high / d), std::max(low / d, high / d));
  };
  const double x = static_cast<double>(node.corner_x_m), z = static_cast<double>(node.corner_z_m),
               side = static_cast<double>(node.side_m);
  const auto [x0, x1] = slab(x, x + side, dx);
  const auto [z0, z1] = slab(z, z + side, dz);
  const double from = std::max({x0, z0, 0.0}), to = std::min(x1, z1);
  return to > from + 0.01 ? from : -1;
}

TEST(Cut, LeavesAreInFrontToBackOrderAlongEveryHalfLine) {
  core::RandomStream random = stream(41, 3);
  for (int i = 0; i < 5; ++i) {
    const Scene scene(random_camera(random, 100), 5, 9000, distances(6));
    Cut cut;
    select_cut(scene.input, cut);
    for (int ray = 0; ray < 100; ++ray) {
      const double turn = random.next_real(0, 6.3);
      double last = 0;
      for (const CutNode& node : cut.nodes) {
        const double at = node.leaf ? entry(node, std::cos(turn), std::sin(turn)) : -1;
        if (at < 0) continue;
        EXPECT_GE(at, last - 0.01);
        last = at;
      }
      EXPECT_GT(last, 5000);
    }
  }
}

TEST(Cut, ParentsPrecedeTheirChildrenAndStoreTheEndOfTheirSubtree) {
  const Scene scene({{3, 4}, {10, 20, 30}}, 5, 5000, distances(6));
  Cut cut;
  select_cut(scene.input, cut);
  for (std::uint32_t i = 0; i < cut.nodes.size(); ++i) {
    const CutNode& node = cut.nodes[i];
    EXPECT_EQ(node.leaf, node.end == i + 1);
    if (node.parent == kNoNode) continue;
    EXPECT_LT(node.parent, i);
    EXPECT_LE(node.end, cut.nodes[node.parent].end);
    EXPECT_EQ(parent_of(node.node), cut.nodes[node.parent].node);
  }
}

TEST(Cut, HysteresisKeepsSplitNodesUntilTheMergeDistance) {
  const std::vector<LevelDistances> levels = distances(1);
  const auto is_fine = [&](double distance_m, Cut& cut) {
    Scene scene({{0, 0}, {-distance_m, 0, 10}}, 0, 0, levels);
    scene.roots = {{{0, 0}, 0}};
    scene.input.roots = scene.roots;
    select_cut(scene.input, cut);
    return cut.nodes.at(0).fine;
  };
  Cut cut;
  EXPECT_FALSE(is_fine(levels[0].split_m + 1, cut));
  EXPECT_TRUE(is_fine(levels[0].split_m - 1, cut));
  EXPECT_TRUE(is_fine(levels[0].split_m + 1, cut));
  EXPECT_TRUE(is_fine(levels[0].merge_m - 1, cut));
  EXPECT_FALSE(is_fine(levels[0].merge_m + 1, cut));
  EXPECT_FALSE(is_fine(levels[0].merge_m - 1, cut));
}

TEST(Cut, MorphHidesEveryChangeOfTheCutInASlowFlight) {
  const std::vector<LevelDistances> levels = distances(6);
  Cut cut;
  std::map<NodeCoord, CutNode> before;
  int splits = 0, merges = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    core::WorldPosition camera{{0, 0}, {tick < 1500 ? tick * 1.0 : (3000 - tick) * 1.0, 20, 31}};
    const Scene scene(core::normalised(camera, kBlock_m), 5, 4000, levels);
    select_cut(scene.input, cut);
    std::map<NodeCoord, CutNode> now;
    for (const CutNode& node : cut.nodes)
      if (node.parent != kNoNode) now[node.node] = node;
    for (const auto& [coord, node] : now) {
      const auto old = before.find(coord);
      if (old != before.end() && old->second.leaf && node.leaf && old->second.fine == node.fine) {
        EXPECT_NEAR(old->second.morph, node.morph, 0.05F);
      } else if (old != before.end() && old->second.leaf && !node.leaf) {  // was split
        EXPECT_EQ(old->second.morph, 0);
        for (unsigned i = 0; i < 4; ++i)
          EXPECT_GT(now.at(child_of(coord, i)).morph, 0.95F);
        ++splits;
      } else if (old != before.end() && !old->second.leaf && node.leaf) {  // took over
        EXPECT_EQ(node.morph, 0);
        for (unsigned i = 0; i < 4; ++i)
          EXPECT_EQ(before.at(child_of(coord, i)).morph, 1);
        ++merges;
      }
    }
    before = std::move(now);
  }
  EXPECT_GT(splits, 20);
  EXPECT_GT(merges, 20);
}

TEST(Cut, CoversExactlyTheGroundWithinTheViewDistance) {
  Scene scene({{3, 4}, {10, 20, 30}}, 6, 8000, distances(7));
  Cut all, near;
  select_cut(scene.input, all);
  scene.input.view_distance_m = 3000;
  select_cut(scene.input, near);
  std::set<NodeCoord> expected, found;
  for (const CutNode& node : all.nodes)
    if (node.distance_m <= 3000) expected.insert(node.node);
  for (const CutNode& node : near.nodes)
    found.insert(node.node);
  EXPECT_EQ(found, expected);
  EXPECT_LT(found.size(), all.nodes.size());
}

TEST(Cut, OnlyNodesThatReachIntoTheWorldExist) {
  for (const std::int32_t corner : {-20, INT32_MAX - 20}) {
    const core::BlockCoord world_corner{corner, corner};
    Scene scene({world_corner, {0, 0, 0}}, 4, 6000, distances(5));
    scene.input.world = {world_corner, 37, 50};
    Cut cut;
    select_cut(scene.input, cut);
    const BlockLevels blocks = raster(cut, world_corner);
    for (int z = 0; z < 50; ++z) {
      for (int x = 0; x < 37; ++x)
        ASSERT_TRUE(blocks.contains({x, z}));
    }
    for (const CutNode& node : cut.nodes) {
      const core::BlockCoord at = corner_block(node.node);
      const std::int64_t side = std::int64_t{1} << node.node.level;
      EXPECT_LT(steps(at.x, corner), 37);
      EXPECT_LT(steps(at.z, corner), 50);
      EXPECT_GT(steps(at.x, corner) + side, 0);
      EXPECT_GT(steps(at.z, corner) + side, 0);
    }
  }
}

TEST(Cut, TheSameCameraAllocatesNothingTheSecondTime) {
  const Scene scene({{3, 4}, {10, 20, 30}}, 6, 8000, distances(7));
  Cut cut;
  select_cut(scene.input, cut);
  select_cut(scene.input, cut);
  const std::set<const void*> memory{cut.nodes.data(), cut.split.data(), cut.split_before.data()};
  select_cut(scene.input, cut);
  const std::set<const void*> later{cut.nodes.data(), cut.split.data(), cut.split_before.data()};
  EXPECT_EQ(memory, later);
}

TEST(DrawnNodes, AreTheLeavesIfEverythingIsReady) {
  const Scene scene({{3, 4}, {10, 20, 30}}, 6, 8000, distances(7));
  Cut cut;
  select_cut(scene.input, cut);
  std::vector<std::uint8_t> scratch, ready(cut.nodes.size(), 1);
  std::vector<std::uint32_t> drawn, leaves;
  drawn_nodes(cut, ready, scratch, drawn);
  for (std::uint32_t i = 0; i < cut.nodes.size(); ++i)
    if (cut.nodes[i].leaf) leaves.push_back(i);
  EXPECT_EQ(drawn, leaves);
}

TEST(DrawnNodes, CoverAllGroundOfReadyNodesAndNeverTwice) {
  core::RandomStream random = stream(41, 4);
  const Scene scene({{3, 4}, {10, 20, 30}}, 5, 3000, distances(6));
  Cut cut;
  select_cut(scene.input, cut);
  for (int i = 0; i < 50; ++i) {
    const double share = random.next_real(0.2, 1);
    std::vector<std::uint8_t> scratch, ready;
    for (std::size_t n = 0; n < cut.nodes.size(); ++n)
      ready.push_back(random.next_unit() < share ? 1 : 0);
    std::vector<std::uint32_t> drawn;
    drawn_nodes(cut, ready, scratch, drawn);
    EXPECT_TRUE(std::ranges::is_sorted(drawn));
    std::vector<int> times(cut.nodes.size(), 0), ready_above(cut.nodes.size(), 0);
    for (const std::uint32_t d : drawn) {
      EXPECT_EQ(ready[d], 1);
      for (std::uint32_t n = d; n < cut.nodes[d].end; ++n)
        ++times[n];
    }
    for (std::uint32_t n = 0; n < cut.nodes.size(); ++n) {
      const std::uint32_t parent = cut.nodes[n].parent;
      ready_above[n] = ready[n] != 0 || (parent != kNoNode && ready_above[parent] != 0) ? 1 : 0;
      EXPECT_LE(times[n], 1);
      if (cut.nodes[n].leaf) {
        EXPECT_EQ(times[n], ready_above[n]);
      }
    }
  }
}

TEST(DrawnNodes, AParentStaysUntilAllItsReplacementsAreReady) {
  const std::vector<LevelDistances> levels = distances(2);
  Scene scene({{0, 0}, {60, 0, 60}}, 1, 0, levels);
  Cut cut;
  select_cut(scene.input, cut);
  ASSERT_EQ(cut.nodes.size(), 5U);
  std::vector<std::uint8_t> scratch, ready{1, 1, 1, 0, 1};
  std::vector<std::uint32_t> drawn;
  drawn_nodes(cut, ready, scratch, drawn);
  EXPECT_EQ(drawn, std::vector<std::uint32_t>{0});
  ready[3] = 1;
  drawn_nodes(cut, ready, scratch, drawn);
  EXPECT_EQ(drawn, (std::vector<std::uint32_t>{1, 2, 3, 4}));
  ready = {0, 1, 0, 0, 1};  // without a fallback, draws the available nodes
  drawn_nodes(cut, ready, scratch, drawn);
  EXPECT_EQ(drawn, (std::vector<std::uint32_t>{1, 4}));
}

}  // namespace
}  // namespace psygen::visibility
