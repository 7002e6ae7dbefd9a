// A river network as the ground of a world: in files, nodes of all levels, queries, hashes, water.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/models/network/store.hpp"
#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/ground_patch.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/edits/edits.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/water.hpp"
#include "tests/engine/world/ground_meshes.hpp"
#include "tests/engine/world/network_world.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world {
namespace {

using testing::expect_equal_seams;
using ::testing::HasSubstr;
using testing::kNetwork;
using testing::kNetworkErosion;
using testing::kNetworkLand;
using testing::mesh_of;
using testing::network_text;
using testing::parsed;
using testing::registry;
using testing::replaced;

constexpr std::size_t kSide = 33;
constexpr double kBlockM = 32;

TEST(NetworkGround, AgreesAlongTheSeamsOfNodesOfALevel) {
  for (const std::string& text : {network_text(), network_text() + kNetworkErosion}) {
    const World world = parsed(text);
    for (int level = 0; level < 6; ++level) {
      for (const core::BlockCoord node : {core::BlockCoord{0, 0}, {17, -9}, {-1000, 300}}) {
        expect_equal_seams(world, node, level);
      }
    }
  }
}

// A neighbour of any size draws the same border from another detail; skirts hide what is between.
TEST(NetworkGround, OfOtherDetailsStaysWithinTheErrorsOfNodes) {
  const World world = parsed(network_text());
  double widest_m = 0;
  for (int level = 0; level < 8; ++level) {
    std::vector<double> apart_m;
    models::DetailErrors errors;
    for (const core::BlockCoord node : {core::BlockCoord{0, 0}, {5, -3}, {-40, 12}}) {
      errors = models::terrain_detail_errors_m(terrain_parameters(world, node, level), 2);
      const auto fine = mesh_of(world, node, level, 0);
      const auto coarse = mesh_of(world, {node.x >> 2, node.z >> 2}, level + 2, 0);
      const std::size_t step = (kSide - 1) / 4;
      const auto first = [&](std::int32_t of) { return static_cast<std::size_t>(of & 3) * step; };
      for (std::size_t k = 0; k <= step; ++k) {
        for (std::size_t i = 0; i <= step; ++i)
          apart_m.push_back(
              std::abs(int{fine[4 * (k * kSide + i)].height} -
                       int{coarse[(first(node.z) + k) * kSide + first(node.x) + i].height}) /
              65535.0 * world.terrain.real(models::kTerrainReliefM));
      }
    }
    std::ranges::sort(apart_m);
    const double usual_m = apart_m[apart_m.size() * 95 / 100];
    EXPECT_LE(apart_m.back(), errors.bound_m + 0.01) << level;
    EXPECT_LE(usual_m, errors.usual_m + 0.01) << level;
    widest_m = std::max(widest_m, apart_m.back());
  }
  EXPECT_GT(widest_m, 20);
}

TEST(NetworkGround, CostsMoreThanNoise) {
  const World network = parsed(network_text()), noise = parsed(kNetworkLand);
  const models::ModelType& terrain = registry()[network.terrain_model];
  for (int level = 0; level < 8; ++level) {
    const double steps = terrain.steps(terrain_parameters(network, {0, 0}, level), 0);
    EXPECT_GT(steps, 3 * terrain.steps(terrain_parameters(noise, {0, 0}, level), 0)) << level;
  }
}

TEST(NetworkGround, MorphsIntoTheHeightsOfTheParent) {
  const World world = parsed(network_text());
  const models::TerrainGrid grid(static_cast<int>(kSide), 1);
  const auto n = static_cast<std::size_t>(grid.n);
  for (int level = 0; level < 4; ++level) {
    const auto child = mesh_of(world, {2, 2}, level, 1),
               parent = mesh_of(world, {1, 1}, level + 1, 1);
    for (std::size_t z = 0; z < n; z += 2) {
      for (std::size_t x = 0; x < n; x += 2)
        ASSERT_EQ(child[z * n + x].coarse_height, parent[z / 2 * n + x / 2].height) << level;
    }
  }
}

TEST(NetworkGround, OfQueriesEqualsThatOfMeshes) {
  const World world = parsed(network_text() + kNetworkErosion);
  for (const core::BlockCoord block : {core::BlockCoord{0, 0}, {40, 7}, {-3, -90}}) {
    const auto mesh = mesh_of(world, block, 0, 0);
    for (std::size_t i = 0; i < kSide * kSide; i += 7) {
      const auto x = static_cast<double>(i % kSide), z = static_cast<double>(i / kSide);
      if (x >= kBlockM || z >= kBlockM) continue;
      EXPECT_NEAR(models::ground_height_m(world.terrain, block, x, z),
                  200.0 * mesh[i].height / 65535.0, 1e-9);
    }
  }
}

// All heights of a node, asked for as placement does.
std::vector<std::uint16_t> heights_of(const World& world, core::BlockCoord node, int level = 0) {
  std::vector<std::uint16_t> heights(kSide * kSide);
  models::BlockGround(terrain_parameters(world, node, level), node, heights.size())
      .heights(heights);
  return heights;
}

// An edit around a place whose mask reads heights and slopes of the land below it.
std::shared_ptr<const models::GroundEdit> masked_stamp(core::WorldPosition centre) {
  models::GroundEdit hill;
  hill.centre = centre;
  hill.radius_m = 3000;
  hill.height_m = 20;
  models::GroundMask mask;
  mask.height_m.min = 25;
  mask.slope.max = 0.8, mask.slope.max_fade = 0.5;
  hill.mask = std::make_shared<const models::GroundMask>(mask);
  seal(hill);
  return std::make_shared<const models::GroundEdit>(hill);
}

// Whatever asks for the ground of a node finds its patches in the store.
TEST(NetworkGround, OfANodeReadsOnlyItsPatches) {
  constexpr core::BlockCoord kNodes[]{{3, -2}, {-8, 15}, {31, 32}};
  for (const bool erodes : {true, false}) {
    const World plain = parsed(network_text() + (erodes ? kNetworkErosion : ""));
    for (const int level : {0, 1, 3, 6, 8}) {
      for (const core::BlockCoord node : kNodes) {
        models::EditLayer layer = *plain.shaped.layer;
        const models::RiverNetwork& before = *layer.ground.network;
        const auto store = std::make_shared<models::NetworkStore>(std::size_t{1} << 30);
        const auto network =
            *models::RiverNetwork::create(before.settings(), before.frame(), store);
        layer.ground.network = network;
        layer.ground.heights = std::make_shared<core::ValueCache>(std::size_t{1} << 26);
        layer.ground.shapes.add(
            masked_stamp({{node.x * (1 << level), node.z * (1 << level)}, {10, 0, 10}}), kBlockM);
        World world = plain;
        set_sun(world.terrain, 100, 12);  // far hills hide it
        world.shaped.layer = std::make_shared<const models::EditLayer>(layer);
        const models::Parameters terrain = terrain_parameters(world, node, level);
        for (const models::network::TileKey& tile : models::ground_patches(terrain))
          static_cast<void>(network->patch(tile));
        const std::size_t bytes = store->bytes();
        static_cast<void>(mesh_of(world, node, level, 0));
        static_cast<void>(mesh_of(world, node, level, 1));
        static_cast<void>(heights_of(world, node, level));
        static_cast<void>(water_parameters(world, node, level));
        EXPECT_EQ(store->bytes(), bytes)
            << "node " << node.x << ' ' << node.z << " of level " << level;
      }
    }
  }
}

TEST(NetworkGround, HasTheSameHeightsWithAndWithoutKeptOnes) {
  const World keeping = parsed(network_text() + kNetworkErosion);
  ASSERT_NE(keeping.shaped.layer->ground.heights, nullptr);
  World forgetting = keeping;
  models::EditLayer layer = *keeping.shaped.layer;
  layer.ground.heights = nullptr;
  forgetting.shaped.layer = std::make_shared<const models::EditLayer>(layer);
  for (const int level : {0, 1, 4}) {
    for (const core::BlockCoord node : {core::BlockCoord{3, -2}, {4, -2}, {-7, 100}}) {
      const auto expected = heights_of(forgetting, node, level);
      EXPECT_EQ(heights_of(keeping, node, level), expected);
      EXPECT_EQ(heights_of(keeping, node, level), expected);
    }
  }
  // Another sun finds the same heights.
  const std::size_t bytes = keeping.shaped.layer->ground.heights->bytes();
  World evening = keeping;
  set_sun(evening.terrain, 250, 8);
  EXPECT_EQ(heights_of(evening, {3, -2}), heights_of(keeping, {3, -2}));
  EXPECT_EQ(keeping.shaped.layer->ground.heights->bytes(), bytes);
}

TEST(NetworkGround, AgreesAlongSeamsUnderAMaskedStamp) {
  World world = parsed(network_text() + kNetworkErosion);
  const World plain = world;
  models::EditLayer layer = *world.shaped.layer;
  layer.ground.shapes.add(masked_stamp({{3, 3}, {10, 0, 10}}), kBlockM);
  world.shaped.layer = std::make_shared<const models::EditLayer>(layer);
  std::size_t raised = 0, same = 0;
  for (int level = 0; level < 5; ++level) {
    for (const core::BlockCoord node : {core::BlockCoord{0, 0}, {1, 1}}) {
      expect_equal_seams(world, node, level);
      const auto with = heights_of(world, node, level), without = heights_of(plain, node, level);
      for (std::size_t i = 0; i < with.size(); ++i)
        ++(with[i] == without[i] ? same : raised);
    }
  }
  EXPECT_GT(raised, 500U);
  EXPECT_GT(same, 500U);
}

TEST(NetworkGround, KeepsNoHeightsOverAnEdit) {
  World world = parsed(network_text() + kNetworkErosion);
  const auto before = heights_of(world, {3, -2}), beside = heights_of(world, {2, -2});
  Edits edits;
  ASSERT_TRUE(edits.raise(world, {{3, -2}, {1, 0, 16}}, 2, 3));  // reaches the border's vertices
  set_edits(world, edits.layer());
  EXPECT_NE(heights_of(world, {3, -2}), before);
  const auto raised = heights_of(world, {2, -2});
  EXPECT_NE(raised, beside);
  EXPECT_EQ(raised[16 * kSide + kSide - 1], heights_of(world, {3, -2})[16 * kSide]);
  set_edits(world, nullptr);
  EXPECT_EQ(heights_of(world, {3, -2}), before);
}

// A river or a lake of the network, and the direction across it.
struct NetworkBody {
  glm::dvec2 at_m, across;
};
NetworkBody wet_place(const World& world, bool is_river) {
  for (double z_m = 20; z_m < 4000; z_m += 20) {
    for (double x_m = 20; x_m < 4000; x_m += 5) {
      const core::WorldPosition at = world.position({x_m, z_m});
      const auto surface = water_surface(world, at);
      if (!surface || surface->body < models::kFirstNetworkBody) continue;
      if (surface->discharge_m3_s.has_value() != is_river) continue;
      const glm::dvec2 flow(surface->flow_m_s);
      const double speed = std::hypot(flow.x, flow.y);
      return {{x_m, z_m}, speed > 0 ? glm::dvec2(-flow.y, flow.x) / speed : glm::dvec2(1, 0)};
    }
  }
  ADD_FAILURE() << "no such water";
  return {};
}
std::string river_between(glm::dvec2 a_m, glm::dvec2 b_m, double width_m) {
  return fmt::format("[[river]]\npoints_m = [[{}, {}], [{}, {}]]\nwidth_m = {}\n", a_m.x, a_m.y,
                     b_m.x, b_m.y, width_m);
}

TEST(NetworkGround, RiversMadeByHandMayEndInWiderOnesOfTheNetworkButNotCrossThem) {
  const World plain = parsed(network_text());
  const auto [river_m, across] = wet_place(plain, true);
  const core::WorldPosition at = plain.position(river_m);
  const double width_m =
      plain.layer()->ground.water_over(at.block, {at.local.x, at.local.z}, kBlockM)->width_m;
  ASSERT_GT(width_m, 2.5);
  const auto error = [](const std::string& tables) {
    models::Registry fresh = models::make_standard_registry();
    const auto world = parse_world(network_text() + tables, "w.toml", fresh);
    return world ? "" : world.error().message;
  };
  const glm::dvec2 from_m = river_m - 60.0 * across, to_m = river_m + 60.0 * across;
  EXPECT_THAT(error(river_between(from_m, to_m, 0.9 * width_m)),
              HasSubstr("the river crosses a wider river of the network near"));
  EXPECT_EQ(error(river_between(from_m, river_m, 0.9 * width_m)), "");
  EXPECT_EQ(error(river_between(river_m, to_m, 0.9 * width_m)), "");
  const std::string taking = river_between(from_m, to_m, 1.1 * width_m);
  ASSERT_EQ(error(taking), "") << "it takes up narrower ones";
  const World crossed = parsed(network_text() + taking);
  const auto surface_of = [](const World& world, glm::dvec2 at_m) {
    const auto water = water_surface(world, world.position(at_m));
    EXPECT_TRUE(water);
    return water.value_or(WaterSurface());
  };
  const WaterSurface taken = surface_of(crossed, river_m);
  EXPECT_LT(taken.body, models::kFirstNetworkBody);
  EXPECT_LE(taken.surface_m, surface_of(plain, river_m).surface_m) << "the narrower one flows in";
  double above_m = surface_of(crossed, river_m - 50.0 * across).surface_m;
  for (double along_m = -40; along_m <= 50; along_m += 10) {
    const double here_m = surface_of(crossed, river_m + along_m * across).surface_m;
    EXPECT_LE(here_m, above_m) << along_m;
    EXPECT_TRUE(along_m >= 0 || here_m < above_m) << "it falls down the slope, " << along_m;
    above_m = here_m;
  }
}

// Rivers lie at many heights, above their beds and below their banks, and flow.
TEST(NetworkGround, HasRiversAtManyHeights) {
  const World world = parsed(network_text());
  std::size_t wet = 0, flowing = 0;
  double lowest_m = 1e9, highest_m = 0;
  for (int z = 0; z < 120; ++z) {
    for (int x = 0; x < 120; ++x) {
      const core::WorldPosition at = core::normalised({{0, 0}, {x * 17.0, 0, z * 17.0}}, kBlockM);
      const WaterPoint water = water_at(world, at);
      if (water.is_dry() || water.body == kSea) continue;
      ++wet;
      flowing += glm::length(water.flow_m_s) > 0.05F ? 1 : 0;
      EXPECT_GT(water.surface_m, 20 - 1e-3) << "no river lies below the sea";
      EXPECT_GT(water.depth_m, 0);
      EXPECT_LT(water.depth_m, 40);
      lowest_m = std::min(lowest_m, water.surface_m);
      highest_m = std::max(highest_m, water.surface_m);
    }
  }
  EXPECT_GT(wet, 20U);
  EXPECT_GT(flowing, 10U);
  EXPECT_GT(highest_m, lowest_m + 10);
}

TEST(NetworkGround, ReadsBackEqualAndChangesTheKeysOfMeshes) {
  const World world = parsed(network_text()), plain = parsed(kNetworkLand);
  const std::string text = write_world(world, registry());
  EXPECT_EQ(parsed(text), world);
  EXPECT_THAT(text, HasSubstr("[rivers]"));
  EXPECT_EQ(write_world(plain, registry()).find("[rivers]"), std::string::npos);
  EXPECT_NE(terrain_parameters(world, {0, 0}).edits_hash(), 0U);
  EXPECT_EQ(terrain_parameters(plain, {0, 0}).edits_hash(), 0U);
}

TEST(NetworkGround, WrongNumbersAreRejectedWithLineAndField) {
  const auto message = [](const std::string& text) {
    const auto world = parse_world(text, "w.toml", registry());
    return world ? std::string("accepted") : world.error().message;
  };
  EXPECT_THAT(message(std::string(kNetworkLand) + "[rivers]\nroot_spacing_m = 10\n"),
              HasSubstr("root_spacing_m"));
  EXPECT_THAT(message(std::string(kNetworkLand) + "[rivers]\nlake_share = 2\n"),
              HasSubstr("lake_share"));
  std::string coarse = std::string(kNetworkLand) + "[rivers]\nroot_spacing_m = 256\n";
  coarse.replace(coarse.find("cell_m = 1"), 10, "cell_m = 50");
  EXPECT_THAT(message(coarse), HasSubstr("nodes"));
}

// Sliders move through all of these.
TEST(NetworkGround, FitsEveryHeightOfTheSeaAndEverySpacing) {
  std::string dry = network_text();
  dry.replace(dry.find("level_m = 20"), 12, "shore_m = 1");
  for (const std::string& text : {dry, replaced(network_text(), "level_m = 20", "level_m = 5000"),
                                  replaced(network_text(), "halvings = 5", "halvings = 8"),
                                  replaced(network_text(), "root_spacing_m = 1024\nhalvings = 5",
                                           "root_spacing_m = 65536\nhalvings = 1")}) {
    const World world = parsed(text);
    EXPECT_EQ(mesh_of(world, {3, 1}, 0, 0)[32].height, mesh_of(world, {4, 1}, 0, 0)[0].height);
  }
}

}  // namespace
}  // namespace psygen::world
