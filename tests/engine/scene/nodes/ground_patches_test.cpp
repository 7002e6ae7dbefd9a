// Nodes of a network world wait for patches that modelers make.
#include "engine/scene/nodes/ground_patches.hpp"

#include <algorithm>
#include <vector>

#include "engine/models/edits.hpp"
#include "engine/models/network/network.hpp"
#include "engine/scene/facts/levels.hpp"
#include "tests/engine/scene/fixture.hpp"
#include "tests/engine/world/network_world.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::scene {
namespace {

using world::testing::network_text;
using world::testing::parsed;

std::unique_ptr<Scene> network_scene(const world::World& world) {
  SceneSettings settings = small_settings();
  settings.view_distance_m = 1000;
  return make_scene(world, settings, models::make_standard_registry());
}

// The nodes of a scene, finest first, without those of the coarsest level, which never wait.
std::vector<visibility::NodeCoord> nodes_of_scene(Scene& scene) {
  const State& s = state_of(scene);
  std::vector<visibility::NodeCoord> nodes;
  s.entities.each<const QuadtreeNode>([&](auto rows, auto of_nodes) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (of_nodes[i].at.level + 1U < s.facts.levels.size()) nodes.push_back(of_nodes[i].at);
    }
  });
  return nodes;
}

// True if the store has every patch that the ground of a node reads.
bool has_patches(const world::World& world, const visibility::NodeCoord& node) {
  const models::RiverNetwork& network = *world.layer()->ground.network;
  return std::ranges::all_of(models::ground_patches(node_terrain(world, node)),
                             [&](const auto& tile) { return network.ready(tile); });
}

constexpr int kTicks = 600;

TEST(GroundPatches, AreMadeBeforeTheNodesThatReadThem) {
  const world::World world = parsed(network_text());
  const auto scene = network_scene(world);
  const State& s = state_of(*scene);
  for (const core::CameraPose& pose : {pose_at(0, 0), pose_at(4000, -3000)}) {
    tick_at(*scene, pose);
    EXPECT_TRUE(nodes_of_scene(*scene).empty()) << "no patch is made here yet";
    std::size_t waited = 0;
    for (int ticks = 0; ticks < kTicks && !s.streaming.missing.empty(); ++ticks) {
      std::vector<visibility::NodeCoord> lacking;
      for (const visibility::NodeCoord& node : s.streaming.missing) {
        if (!has_patches(world, node)) lacking.push_back(node);
      }
      waited += lacking.size();
      tick_at(*scene, pose);
      for (const visibility::NodeCoord& node : nodes_of_scene(*scene))
        EXPECT_EQ(std::ranges::count(lacking, node), 0);
    }
    EXPECT_GT(waited, 0U);
    EXPECT_TRUE(s.streaming.missing.empty());
    EXPECT_GT(nodes_of_scene(*scene).size(), 100U);
  }
}

// How many nodes each tick creates over land that the store may already have.
std::vector<std::uint32_t> created_in(const world::World& world) {
  const auto scene = network_scene(world);
  std::vector<std::uint32_t> created;
  for (int i = 0; i < 120; ++i) {
    tick_at(*scene, i < 60 ? pose_at(7, 7) : pose_at(900, -40));
    created.push_back(scene->statistics().nodes.created);
  }
  return created;
}

TEST(GroundPatches, TheStoreDoesNotDecideWhenNodesAppear) {
  const world::World world = parsed(network_text());
  const std::vector<std::uint32_t> cold = created_in(world);
  EXPECT_GT(std::ranges::count_if(cold, [](std::uint32_t n) { return n > 0; }), 5);
  EXPECT_EQ(created_in(world), cold) << "with a store that has all patches";
}

TEST(GroundPatches, AChangeOfTheWorldLeavesNoNodeWaiting) {
  const std::string text = network_text();
  const auto scene = network_scene(parsed(text));
  const State& s = state_of(*scene);
  const auto with = [&text](const char* from, const char* to) {
    return world::testing::replaced(text, from, to);
  };
  for (const std::string& next :
       {with("level_m = 20", "level_m = 21"), with("seed = 11", "seed = 12"),
        with("octaves = 7", "octaves = 6"), std::string(world::testing::kNetworkLand)}) {
    tick_at(*scene, pose_at(5, 5));
    EXPECT_GT(s.streaming.missing.size() + nodes_of_scene(*scene).size(), 0U);
    ASSERT_TRUE(scene->set_world(parsed(next), models::make_standard_registry()));
    for (int i = 0; i < kTicks && (i == 0 || !s.streaming.missing.empty()); ++i)
      tick_at(*scene, pose_at(5, 5));
    EXPECT_TRUE(s.streaming.missing.empty()) << next;
    EXPECT_GT(nodes_of_scene(*scene).size(), 100U);
  }
}

// Another scatter, say, leaves the network as it is: the new world finds all of its patches.
TEST(GroundPatches, StayWhenAWorldWithTheSameNetworkFollows) {
  const std::string text = network_text();
  const auto scene = network_scene(parsed(text));
  scene->settle(pose_at(3, 3));
  const models::RiverNetwork* const before =
      state_of(*scene).facts.world.layer()->ground.network.get();
  ASSERT_TRUE(scene->set_world(parsed(text + "\n[[scatter]]\nmodel = \"rock\"\ncount = 2\n"),
                               models::make_standard_registry()));
  const world::World& world = state_of(*scene).facts.world;
  EXPECT_EQ(world.layer()->ground.network.get(), before);
  EXPECT_EQ(world.terrain.edits(), world.layer().get());
  for (const visibility::NodeCoord& node : nodes_of_scene(*scene))
    EXPECT_TRUE(has_patches(world, node));
}

// The water of all nodes is listed at once when another network follows.
TEST(GroundPatches, OfAnotherNetworkAreMadeWithTheWorldThatFollows) {
  const std::string text = network_text();
  const auto scene = network_scene(parsed(text));
  scene->settle(pose_at(3, 3));
  models::Registry registry = models::make_standard_registry();
  const auto prepared =
      prepare_world(parsed(world::testing::replaced(text, "seed = 11", "seed = 12")),
                    std::move(registry), scene->snapshot());
  ASSERT_TRUE(prepared);
  const models::RiverNetwork& network = *prepared->facts.world.layer()->ground.network;
  const double cells =
      static_cast<double>(prepared->facts.world.terrain.integer(models::kTerrainSize) - 1);
  for (const visibility::NodeCoord& node : nodes_of_scene(*scene)) {
    const auto first = static_cast<std::int64_t>(cells * std::ldexp(node.coord.x, node.level));
    const auto last = static_cast<std::int64_t>(cells * std::ldexp(node.coord.z, node.level));
    EXPECT_TRUE(
        network.ready(network.tile_of(first, last, models::GroundDetail::of_node(node.level))));
  }
}

TEST(GroundPatches, ThatNoNodeAskedForLatelyAreForgotten) {
  const world::World world = parsed(network_text());
  const auto scene = network_scene(world);
  State& s = state_of(*scene);
  for (int place = 0; place < 40; ++place) {
    for (int i = 0; i < kTicks && (i == 0 || !s.streaming.missing.empty()); ++i)
      tick_at(*scene, pose_at(1000 * place, 0));
    EXPECT_TRUE(s.streaming.missing.empty());
    EXPECT_LE(s.patches.known(), GroundPatches::kMaxKnown + 64);
  }
}

// Games ask at full detail about places that the scene draws coarsely.
TEST(GroundPatches, AroundTheCameraAreMadeAtFullDetail) {
  const world::World world = parsed(network_text());
  const models::RiverNetwork& network = *world.layer()->ground.network;
  const auto scene = network_scene(world);
  for (const core::CameraPose& pose : {pose_at(10, 10), pose_at(-2900, 1700)}) {
    for (int i = 0; i < 60; ++i)
      tick_at(*scene, pose);
    const glm::dvec2 at_m = world.metres(pose.position);
    for (int x = -4; x <= 4; ++x) {
      for (int z = -4; z <= 4; ++z) {
        const auto cells = [&](double m, int k) {
          return std::llround((m + k * GroundPatches::kAskedM / 4) / world.cell_m());
        };
        EXPECT_TRUE(network.ready(network.tile_of(cells(at_m.x, x), cells(at_m.y, z), {})))
            << x << " " << z;
      }
    }
  }
}

TEST(GroundPatches, PrefillMakesAllOfThem) {
  const world::World world = parsed(network_text());
  const auto scene = network_scene(world);
  EXPECT_GT(scene->settle(pose_at(3, 3)), 0U);
  EXPECT_TRUE(state_of(*scene).streaming.missing.empty());
  for (const visibility::NodeCoord& node : nodes_of_scene(*scene))
    EXPECT_TRUE(has_patches(world, node));
}

TEST(GroundPatches, NoParadigmWaitsForPatchesThatNobodyMakes) {
  const world::World world = parsed(network_text());
  SceneSettings settings = small_settings();
  for (const Paradigm paradigm : {Paradigm::kLazyEvaluation, Paradigm::kDataAmplification,
                                  Paradigm::kParallelLazyAmplification}) {
    settings.paradigm = paradigm;
    const auto scene = make_scene(world, settings, models::make_standard_registry());
    if (paradigm != Paradigm::kLazyEvaluation) {
      EXPECT_TRUE(scene->amplify(pose_at(3, 3)));
    }
    tick_at(*scene, pose_at(3, 3));
    EXPECT_TRUE(state_of(*scene).streaming.missing.empty());
    EXPECT_EQ(scene->statistics().drawn.holes, 0U);
  }
}

}  // namespace
}  // namespace psygen::scene
