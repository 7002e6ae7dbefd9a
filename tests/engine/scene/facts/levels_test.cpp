#include "engine/scene/facts/levels.hpp"

#include <algorithm>
#include <set>

#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/far/merged_models.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

std::vector<NodeLevel> levels_of(const world::World& world, const SceneSettings& settings) {
  return node_levels(world, models::make_standard_registry(), settings, nullptr);
}

world::World world_of(std::int64_t blocks_x, std::int64_t blocks_z, int vertices = 64) {
  world::World world = paper_world(models::make_standard_registry());
  world.blocks_x = blocks_x;
  world.blocks_z = blocks_z;
  world.terrain.set_integer(models::kTerrainSize, vertices);
  return world;
}

TEST(NodeLevels, AFartherViewHasMoreAndWithoutLevelsOfDetailThereIsOne) {
  SceneSettings settings;
  std::size_t before = 0;
  for (const double view_m : {32.0, 130.0, 1000.0, 4000.0, 16000.0, 65536.0}) {
    settings.view_distance_m = view_m;
    const auto levels = levels_of(world_of(0, 0), settings);
    EXPECT_GE(levels.size(), std::max<std::size_t>(before, 1));
    EXPECT_LT(levels.back().size_m, std::max(view_m, 64.0)) << "several nodes around the camera";
    EXPECT_GE(2 * levels.back().size_m, view_m) << "but few";
    before = levels.size();
  }
  EXPECT_GE(before, 8u);
  settings.levels_of_detail = false;
  EXPECT_EQ(levels_of(world_of(0, 0), settings).size(), 1u);
}

TEST(NodeLevels, NoneIsMuchLargerThanTheWorld) {
  SceneSettings settings;
  settings.view_distance_m = 65536;
  EXPECT_EQ(levels_of(world_of(1, 1), settings).size(), 1u);
  EXPECT_EQ(levels_of(world_of(3, 5), settings).size(), 4u);  // a node of 8 × 8 holds it all
  EXPECT_EQ(levels_of(world_of(512, 1), settings).size(),
            levels_of(world_of(512, 512), settings).size());
}

TEST(NodeLevels, TheirSidesDoubleAndTheirErrorsGrow) {
  for (const int vertices : {8, 17, 59, 64, 97}) {
    const auto levels = levels_of(world_of(0, 0, vertices), SceneSettings{});
    for (std::size_t k = 0; k < levels.size(); ++k) {
      SCOPED_TRACE(testing::Message() << vertices << " vertices, level " << k);
      EXPECT_EQ(levels[k].size_m, static_cast<double>(vertices - 1) * static_cast<double>(1 << k));
      EXPECT_GT(levels[k].ground_error_m, 0);
      EXPECT_GE(levels[k].error_m, levels[k].ground_error_m);
      EXPECT_GE(levels[k].ground_bound_m, levels[k].ground_error_m);
      EXPECT_GT(static_cast<double>(levels[k].skirt_m), levels[k].ground_error_m);
      EXPECT_LT(levels[k].bounds.min.y, levels[k].bounds.max.y);
      if (k > 0) {
        EXPECT_GE(levels[k].ground_error_m, levels[k - 1].ground_error_m);
      }
    }
  }
}

// Returns by how much the skirts of changed ground are deeper than those of plain ground, by level.
std::vector<float> deeper_skirts(const world::World& plain, const world::World& changed) {
  const auto before = levels_of(plain, SceneSettings{}),
             levels = levels_of(changed, SceneSettings{});
  EXPECT_EQ(before.size(), levels.size());
  std::vector<float> deeper;
  if (before.size() != levels.size()) return deeper;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const models::Parameters p = node_terrain(changed, {{}, static_cast<std::uint8_t>(k)});
    const double details_m = models::terrain_detail_errors_m(p, 2).bound_m;
    deeper.push_back(levels[k].skirt_m - before[k].skirt_m);
    EXPECT_GE(static_cast<double>(deeper[k]), details_m - 0.01) << k;
    EXPECT_GE(levels[k].ground_bound_m, levels[k].ground_error_m) << k;
    EXPECT_GT(static_cast<double>(levels[k].skirt_m), 0.8 * levels[k].ground_error_m) << k;
  }
  return deeper;
}

TEST(NodeLevels, OfErodedGroundHaveSkirtsForNeighboursWithFewerGullies) {
  const world::World plain = world_of(0, 0);
  world::World eroded = plain;
  eroded.shaped.erosion.strength = 0.6;
  ASSERT_TRUE(world::shape_ground(eroded));
  const std::vector<float> deeper = deeper_skirts(plain, eroded);
  ASSERT_GT(deeper.size(), 3u);
  EXPECT_GT(deeper[3], 5);
}

TEST(NodeLevels, OfRiverNetworksHaveSkirtsForNeighboursWithFewerRivers) {
  const world::World plain = world_of(0, 0);
  world::World network = plain;
  network.shaped.network.emplace();
  ASSERT_TRUE(world::shape_ground(network));
  const std::vector<float> deeper = deeper_skirts(plain, network);
  ASSERT_FALSE(deeper.empty());
  EXPECT_GT(deeper.back(), 20);
}

// The nodes of a level that 100 samples of a world belong to.
std::set<core::BlockCoord> sampled_nodes(const world::World& world, std::uint8_t level) {
  const SampleBlocks blocks(world);
  core::RandomStream random(1, 0, 0, 0, core::Purpose::kParameters);
  std::set<core::BlockCoord> nodes;
  for (int i = 0; i < 100; ++i)
    nodes.insert(visibility::node_of(blocks.next(random, level), level).coord);
  return nodes;
}

TEST(SampleBlocks, OfARiverNetworkLieTogetherOnLand) {
  world::World world = world_of(0, 0);
  EXPECT_GT(sampled_nodes(world, 2).size(), 90U);
  world.water.level_m = 0.4 * world.terrain.real(models::kTerrainReliefM);
  world.shaped.network.emplace().sea_share = 0.6;
  ASSERT_TRUE(world::shape_ground(world));
  for (const std::uint8_t level : {std::uint8_t{0}, std::uint8_t{2}, std::uint8_t{5}})
    EXPECT_EQ(sampled_nodes(world, level).size(), 16U) << int{level};
  core::RandomStream random(1, 0, 0, 0, core::Purpose::kParameters);
  const SampleBlocks blocks(world);
  double highest_m = 0;
  for (int i = 0; i < 20; ++i)
    highest_m =
        std::max(highest_m, models::ground_height_m(world.terrain, blocks.next(random), 0, 0));
  EXPECT_GT(highest_m, world.water.level_m);
}

TEST(NodeLevels, ANodeExistsIfAnyOfItsBlocksDoes) {
  const world::World small = world_of(3, 5), strip = world_of(0, 4);
  EXPECT_TRUE(contains(small, {{0, 0}, 0}));
  EXPECT_TRUE(contains(small, {{2, 4}, 0}));
  EXPECT_FALSE(contains(small, {{3, 4}, 0}));
  EXPECT_FALSE(contains(small, {{2, 5}, 0}));
  EXPECT_FALSE(contains(small, {{-1, 0}, 0}));
  EXPECT_TRUE(contains(small, {{1, 2}, 1}));  // reaches over both edges
  EXPECT_FALSE(contains(small, {{2, 0}, 1}));
  EXPECT_TRUE(contains(small, {{0, 0}, 3}));
  EXPECT_FALSE(contains(small, {{-1, -1}, 3}));
  EXPECT_TRUE(contains(strip, {{INT32_MIN, 0}, 0}));
  EXPECT_TRUE(contains(strip, {{INT32_MAX, 3}, 0}));
  EXPECT_FALSE(contains(strip, {{7, 4}, 0}));
}

// For any camera and any allowed error.
struct Wish {
  double view_m, error_pixels, pixels_per_radian;
};
constexpr Wish kWishes[] = {{32, 4, 200},   {130, 0.5, 700},  {1000, 4, 1120},
                            {4000, 16, 90}, {16000, 4, 1120}, {65536, 1, 2200}};

TEST(NodeLevels, ANodeOverhangsIfSomeOfItsBlocksDoNotExist) {
  const world::World small = world_of(3, 5), strip = world_of(0, 4), endless = world_of(0, 0);
  EXPECT_FALSE(overhangs(small, {{2, 4}, 0}));
  EXPECT_FALSE(overhangs(small, {{0, 1}, 1}));
  EXPECT_TRUE(overhangs(small, {{1, 0}, 1}));
  EXPECT_TRUE(overhangs(small, {{0, 2}, 1}));
  EXPECT_TRUE(overhangs(small, {{-1, 0}, 0}));
  EXPECT_FALSE(overhangs(strip, {{-9, 0}, 2}));
  EXPECT_TRUE(overhangs(strip, {{-9, 0}, 3}));
  EXPECT_FALSE(overhangs(endless, {{-9, 7}, 5}));
}

TEST(NodeLevels, NodesSplitWhereTheirErrorIsVisible) {
  for (const Wish& wish : kWishes) {
    SceneSettings settings;
    settings.view_distance_m = wish.view_m;
    const auto levels = levels_of(world_of(0, 0), settings);
    std::vector<visibility::LevelDistances> distances;
    split_distances(levels, settings, wish.pixels_per_radian, wish.error_pixels, distances);
    ASSERT_EQ(distances.size(), levels.size());
    for (std::size_t k = 1; k < levels.size(); ++k) {
      const double seen_m = levels[k].error_m * wish.pixels_per_radian / wish.error_pixels;
      EXPECT_GE(distances[k].split_m, std::min(seen_m, 3.0 * levels[k].size_m));
      EXPECT_GE(distances[k].split_m, 0.6 * levels[k].size_m);
      EXPECT_GE(distances[k].split_m, distances[k - 1].merge_m);
      EXPECT_GE(distances[k].merge_m, distances[k].split_m);
      EXPECT_LE(distances[k].morph_m, 0.75 * distances[k].split_m) << "room for morphing";
      EXPECT_GE(distances[k].morph_m, distances[k - 1].merge_m);
      EXPECT_LE(distances[k].split_m, 4.0 * levels[k].size_m);
    }
  }
}

// A governor under pressure may allow any error: trees are drawn as models for three kilometres.
TEST(NodeLevels, ForestsAreMoreThanAColourForThreeKilometresAtAnyError) {
  models::Registry registry = models::make_standard_registry();
  const auto world = std::make_shared<const world::World>(paper_world(registry));
  const auto merged = world::make_merged_type(world, registry);
  const auto levels = node_levels(*world, registry, SceneSettings{}, merged.get());
  constexpr std::size_t kColour = world::kMaxMergedLevel + 1;
  ASSERT_GT(levels.size(), kColour);
  EXPECT_TRUE(levels[kColour - 1].merged);
  EXPECT_FALSE(levels[kColour].merged);
  for (const double error_pixels : {4.0, 8.0, 16.0, 64.0}) {
    std::vector<visibility::LevelDistances> distances;
    split_distances(levels, SceneSettings{}, 745, error_pixels, distances);
    visibility::Cut cut;
    visibility::CutInput input;
    input.camera = {{100, 100}, {7, 20, 50}};
    input.block_size_m = world->block_size_m();
    input.levels = distances;
    input.view_distance_m = 16000;
    std::vector<visibility::NodeCoord> roots;
    visibility::roots_around(input.camera, input.block_size_m, input.view_distance_m,
                             static_cast<std::uint8_t>(levels.size() - 1), roots);
    input.roots = roots;
    visibility::select_cut(input, cut);
    for (const visibility::CutNode& node : cut.nodes) {
      if (!node.leaf || node.distance_m > 3000) continue;
      EXPECT_LE(node.node.level, world::kMaxMergedLevel) << error_pixels << " pixels";
    }
  }
}

// For any camera position in its block, all nodes of the cut have a cell in the window and exist.
TEST(NodeLevels, EveryWantedNodeExistsAsSoonAsTimeAllows) {
  for (const Wish& wish : kWishes) {
    for (const int vertices : {59, 64}) {
      SceneSettings settings = small_settings();
      settings.view_distance_m = wish.view_m;
      settings.max_error_pixels = wish.error_pixels;
      settings.main_thread_budget_ms = 0;
      const auto scene = make_scene_of(settings, [&](world::World& world) {
        world.blocks_x = world.blocks_z = 0;
        world.scatter.clear();
        world.terrain.set_integer(models::kTerrainSize, vertices);
      });
      State& s = state_of(*scene);
      const double side_m = s.facts.world.block_size_m();
      for (const glm::dvec2 at : {glm::dvec2(0, 0), {0.999, 0.001}, {0.5, 0.5}, {0.01, 0.99}}) {
        core::CameraPose pose;
        pose.position = {{-3, 1000}, {at.x * side_m, 50, at.y * side_m}};
        tick_at(*scene, pose);
        std::size_t missing = 0;
        for (const visibility::CutNode& node : s.view.cut.nodes) {
          const NodeGrid& grid = s.streaming.grids[node.node.level];
          missing +=
              !grid.contains(node.node.coord) || !s.entities.alive(grid.entity_of(node.node.coord));
        }
        EXPECT_EQ(missing, 0u) << wish.view_m << " m, " << vertices << " vertices";
        EXPECT_GT(s.view.cut.nodes.size(), 0u);
      }
    }
  }
}

// The camera does not move, so that only the error requires more nodes.
TEST(NodeLevels, EveryWantedNodeExistsWhileTheErrorFalls) {
  for (const double view_m : {2000.0, 6000.0, 16000.0}) {
    SceneSettings settings = small_settings();
    settings.view_distance_m = view_m;
    settings.max_error_pixels = 16;
    settings.main_thread_budget_ms = 0;
    const auto scene = make_scene_of(settings, [](world::World& world) {
      world.blocks_x = world.blocks_z = 0;
      world.scatter.clear();
    });
    State& s = state_of(*scene);
    std::size_t missing = 0, before = 0;
    for (; s.settings.max_error_pixels > 2; s.settings.max_error_pixels *= 0.99) {
      tick_at(*scene, pose_at(100, 200));
      if (before == 0) before = s.view.cut.nodes.size();
      for (const visibility::CutNode& node : s.view.cut.nodes) {
        const NodeGrid& grid = s.streaming.grids[node.node.level];
        missing +=
            !grid.contains(node.node.coord) || !s.entities.alive(grid.entity_of(node.node.coord));
      }
    }
    EXPECT_EQ(missing, 0u) << view_m << " m";
    EXPECT_GT(s.view.cut.nodes.size(), 2 * before);
  }
}

TEST(NodeLevels, WorldsOfAnySizeAndShapeAreDrawnWithoutHoles) {
  struct Case {
    std::int64_t x, z;
    int vertices;
    double view_m;
    bool levels_of_detail;
  };
  for (const Case& c : {Case{1, 1, 64, 16000, true},
                        {1, 1, 64, 32, true},
                        {3, 5, 59, 1000, true},
                        {3, 5, 64, 65536, true},
                        {3, 5, 59, 1000, false},
                        {0, 4, 17, 500, true},
                        {512, 1, 64, 400, true},
                        {512, 512, 8, 32, true},
                        {0, 0, 97, 65536, true}}) {
    SCOPED_TRACE(testing::Message() << c.x << " x " << c.z << " blocks of " << c.vertices);
    SceneSettings settings = small_settings();
    settings.view_distance_m = c.view_m;
    settings.levels_of_detail = c.levels_of_detail;
    const auto scene = make_scene_of(settings, [&](world::World& world) {
      world.blocks_x = c.x;
      world.blocks_z = c.z;
      world.scatter.clear();
      world.terrain.set_integer(models::kTerrainSize, c.vertices);
    });
    for (const double yaw : {0.4, 3.6}) {
      core::CameraPose pose = pose_at(0, 0, yaw);
      pose.position.local = {3, 180, 2};
      pose.pitch = -0.5;
      scene->settle(pose);
      tick_at(*scene, pose);
      EXPECT_EQ(scene->statistics().drawn.holes, 0u);
      EXPECT_EQ(scene->statistics().meshes.requests, 0u);
    }
    EXPECT_GT(state_of(*scene).entities.count<QuadtreeNode>(), 0u);
  }
}

}  // namespace
}  // namespace psygen::scene
