// Scenes do not depend on the size of the world or the distance from its origin.
#include "engine/models/terrain/terrain.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

SceneSettings far_settings() {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 3000;
  settings.max_error_pixels = 16;
  return settings;
}

// An endless and nearly flat world, so that all places look alike; only the places of models are
// random.
std::unique_ptr<Scene> endless_scene() {
  SceneSettings settings = far_settings();
  settings.occlusion = false;
  return make_scene_of(settings, [](world::World& world) {
    world.blocks_x = world.blocks_z = 0;
    world.terrain.set_real(models::kTerrainReliefM, 0.01);
    world.scatter.clear();
  });
}

core::CameraPose endless_pose(core::BlockCoord block) {
  core::CameraPose pose;
  pose.position = {block, {20.25, 30.5, 40.125}};
  pose.pitch = -0.25;
  pose.yaw = 0.7;
  return pose;
}

constexpr core::BlockCoord kPlaces[] = {{0, 0},
                                        {1 << 30, -(1 << 30)},
                                        {INT32_MAX, INT32_MIN},
                                        {INT32_MIN, INT32_MAX},
                                        {INT32_MAX - 15, 15}};

TEST(Extent, EveryPlaceInAnEndlessWorldHasAsManyNodesAndDraws) {
  std::size_t nodes = 0, entities = 0, draws = 0;
  for (const core::BlockCoord block : kPlaces) {
    SCOPED_TRACE(testing::Message() << "block " << block.x << ", " << block.z);
    const auto scene = endless_scene();
    // The same place in every node of 32 × 32 blocks.
    const core::BlockCoord aligned{block.x & ~31, block.z & ~31};
    scene->settle(endless_pose(aligned));
    tick_at(*scene, endless_pose(aligned));
    const State& s = state_of(*scene);
    EXPECT_EQ(s.draws.counts.holes, 0u);
    if (nodes == 0) {
      nodes = s.view.cut.nodes.size();
      entities = s.entities.size();
      draws = s.draws.terrain.size();
    }
    EXPECT_EQ(s.view.cut.nodes.size(), nodes);
    EXPECT_EQ(s.entities.size(), entities);
    EXPECT_EQ(s.draws.terrain.size(), draws);
    EXPECT_GT(draws, 20u);
  }
}

// Steps from one block to another on the ring of 2^32.
std::int64_t steps(std::int32_t from, std::int32_t to) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(to) -
                                   static_cast<std::uint32_t>(from));
}

TEST(Extent, PositionsAreExactToTheMillimetre) {
  for (const core::BlockCoord block : kPlaces) {
    SCOPED_TRACE(testing::Message() << "block " << block.x << ", " << block.z);
    SceneSettings settings = far_settings();
    settings.view_distance_m = 1500;
    const auto scene =
        make_scene_of(settings, [](world::World& world) { world.blocks_x = world.blocks_z = 0; });
    const core::CameraPose pose = endless_pose(block);
    scene->settle(pose);
    tick_at(*scene, pose);
    const State& s = state_of(*scene);
    // In units of 2^-10 mm everything is whole: blocks are 63 m wide.
    constexpr std::int64_t kPerM = 1'024'000, kBlock = 63 * kPerM;
    const auto eye_x = static_cast<std::int64_t>(20.25 * kPerM),
               eye_z = static_cast<std::int64_t>(40.125 * kPerM);
    std::size_t drawn = 0, nodes = 0;
    double worst_mm = 0;
    for (std::size_t i = 0; i < s.draws.nodes.size(); ++i) {
      const std::uint32_t index = s.draws.nodes[i];
      if (s.view.in_view[index] == 0) continue;
      const core::BlockCoord corner = visibility::corner_block(s.view.cut.nodes[index].node);
      const double x = static_cast<double>(steps(block.x, corner.x) * kBlock - eye_x) / 1024,
                   z = static_cast<double>(steps(block.z, corner.z) * kBlock - eye_z) / 1024;
      ++nodes;
      // Of a node's ground there are some draws, or none if all of it is behind a ridge.
      const std::uint32_t mesh = s.entities.get<Mesh>(s.draws.entities[index])->range.id;
      for (; drawn < s.draws.terrain.size() && s.draws.terrain[drawn].range.id == mesh; ++drawn) {
        const render::TerrainDraw& draw = s.draws.terrain[drawn];
        worst_mm = std::max({worst_mm, std::abs(1000 * double{draw.origin.x} - x),
                             std::abs(1000 * double{draw.origin.z} - z)});
      }
    }
    EXPECT_EQ(drawn, s.draws.terrain.size());
    EXPECT_GT(nodes, 5u);
    EXPECT_GT(drawn, 5u);
    EXPECT_LT(worst_mm, 1.0);
  }
}

TEST(Extent, ACameraThatMovesByAMillimetreMovesNothingFarther) {
  for (const core::BlockCoord block : kPlaces) {
    SCOPED_TRACE(testing::Message() << "block " << block.x << ", " << block.z);
    const auto scene = make_scene_of(
        far_settings(), [](world::World& world) { world.blocks_x = world.blocks_z = 0; });
    core::CameraPose pose = endless_pose(block);
    scene->settle(pose);
    tick_at(*scene, pose);
    const DrawLists before = state_of(*scene).draws;
    pose.position.local += glm::dvec3(0.001, 0, -0.001);
    tick_at(*scene, pose);
    const DrawLists& now = state_of(*scene).draws;
    ASSERT_EQ(now.terrain.size(), before.terrain.size());
    ASSERT_EQ(now.models.size(), before.models.size());
    float farthest_m = 0;
    const auto moved = [&](const glm::vec3& from, const glm::vec3& to) {
      const glm::vec3 by = glm::abs(to - from);
      farthest_m = std::max({farthest_m, by.x, by.y, by.z});
    };
    for (std::size_t i = 0; i < now.terrain.size(); ++i) {
      moved(before.terrain[i].origin, now.terrain[i].origin);
      EXPECT_NEAR(now.terrain[i].morph, before.terrain[i].morph, 1e-3F);
    }
    for (std::size_t i = 0; i < now.models.size(); ++i)
      moved(before.models[i].origin, now.models[i].origin);
    EXPECT_LE(farthest_m, 0.00125F);  // a quarter of a millimetre is a step of floats at 3000 m
  }
}

TEST(Extent, AWorldOfAMillionBlocksASideTakesNoMoreThanOneOf512) {
  struct Taken {
    std::size_t entities, nodes, draws, models, meshes;
    std::uint64_t bytes;
    bool operator==(const Taken&) const = default;
  };
  // Independent of synthesis times: the cache keeps recently drawn meshes.
  SceneSettings settings = far_settings();
  settings.main_thread_budget_ms = 0;
  settings.plan_seconds_ahead = 1e6;
  std::vector<Taken> sizes;
  for (const std::int64_t blocks : {std::int64_t{512}, std::int64_t{1} << 20}) {
    const auto scene = make_scene_of(
        settings, [&](world::World& world) { world.blocks_x = world.blocks_z = blocks; });
    core::CameraPose pose = pose_at(256, 256, 0.3);
    scene->settle(pose);
    tick_at(*scene, pose);
    const State& s = state_of(*scene);
    const synthesis::CacheStats stats = s.supply.stats();
    sizes.push_back({s.entities.size(), s.view.cut.nodes.size(), s.draws.terrain.size(),
                     s.draws.models.size(), stats.ready, stats.bytes});
  }
  EXPECT_EQ(sizes[1], sizes[0]) << sizes[0].entities << " and " << sizes[1].entities
                                << " entities, " << sizes[0].bytes << " and " << sizes[1].bytes
                                << " bytes";
  EXPECT_GT(sizes[0].entities, 1000u);
}

void make_small(world::World& world, std::int64_t blocks) {
  world.blocks_x = world.blocks_z = blocks;
  world.terrain.set_integer(models::kTerrainSize, 4);
  world.terrain.set_real(models::kTerrainCellM, 0.01);  // blocks of 3 cm
  world.scatter.resize(1);
}

std::size_t places_of(const Scene& scene) {
  std::size_t places = 0;
  for (const NodeGrid& grid : state_of(scene).streaming.grids)
    places += std::size_t{grid.side()} * grid.side();
  return places;
}

TEST(Extent, AWorldOfAFewCentimetresIsDrawnFromInsideAndFromADistance) {
  for (const std::int64_t blocks : {1, 30}) {
    SceneSettings settings = small_settings();
    settings.view_distance_m = 16'000;
    const auto scene =
        make_scene_of(settings, [blocks](world::World& world) { make_small(world, blocks); });
    EXPECT_LT(places_of(*scene), 10'000u);
    const State& s = state_of(*scene);
    for (const std::int32_t x : {0, -3000, 3000}) {  // 90 m to the west and to the east
      const core::CameraPose pose = pose_at(x, 0);
      scene->settle(pose);
      tick_at(*scene, pose);
      EXPECT_FALSE(s.view.cut.nodes.empty()) << blocks << " blocks, from " << x;
      EXPECT_GT(s.entities.count<QuadtreeNode>(), 0u) << blocks << " blocks, from " << x;
      EXPECT_TRUE(s.streaming.missing.empty());
    }
  }
}

// Without levels of detail every block has its own cell.
TEST(Extent, AVeryLongStripOfTinyBlocksIsRejected) {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 16'000;
  settings.levels_of_detail = false;
  for (const std::int64_t depth : {0, 1 << 30}) {
    models::Registry registry = models::make_standard_registry();
    world::World world = paper_world(registry);
    make_small(world, 1);
    world.blocks_z = depth;
    world.scatter.clear();
    const auto scene = Scene::create(world, std::move(registry), settings, nullptr);
    ASSERT_FALSE(scene.has_value());
    EXPECT_EQ(scene.error().code, core::ErrorCode::kOverBudget);
    EXPECT_NE(scene.error().message.find("blocks of 0.03 m"), std::string::npos)
        << scene.error().message;
  }
}

// Inside, on the edge, just outside, and at the view distance from the world.
TEST(Extent, EveryWantedNodeOfASmallWorldExistsForAnyCamera) {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 1000;
  const auto scene = make_scene_of(settings, [](world::World& world) {
    world.blocks_x = 6;
    world.blocks_z = 3;
    world.scatter.clear();
  });
  const State& s = state_of(*scene);
  for (const core::BlockCoord block :
       {core::BlockCoord{2, 1}, {5, 2}, {6, 0}, {-1, -1}, {12, 1}, {1, -14}, {-15, 2}, {2, 1}}) {
    tick_at(*scene, pose_at(block.x, block.z));
    EXPECT_FALSE(s.view.cut.nodes.empty());
    for (const visibility::CutNode& node : s.view.cut.nodes) {
      const NodeGrid& grid = s.streaming.grids[node.node.level];
      EXPECT_TRUE(grid.contains(node.node.coord) &&
                  s.entities.alive(grid.entity_of(node.node.coord)))
          << "from " << block.x << ", " << block.z;
    }
  }
}

}  // namespace
}  // namespace psygen::scene
