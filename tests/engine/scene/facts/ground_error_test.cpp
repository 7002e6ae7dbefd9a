
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/core/vertex_layout.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/scene/facts/levels.hpp"
#include "tests/engine/scene/fixture.hpp"

namespace psygen::scene {
namespace {

const models::Registry& standard_types() {
  static const models::Registry standard = models::make_standard_registry();
  return standard;
}

// The fraction of a node's vertices that lie within `error_m` of the next coarser surface.
double share_within(const world::World& world, const visibility::NodeCoord& node, double error_m) {
  const models::ModelType& terrain = standard_types()[world.terrain_model];
  const models::Parameters p = node_terrain(world, node);
  const models::MeshSize size = terrain.mesh_size(p, 0);
  std::vector<std::byte> vertices(size.vertex_count * sizeof(core::TerrainVertex));
  std::vector<std::uint16_t> indices(size.shared_indices == 0 ? size.index_count : 0);
  terrain.synthesise(p, 0, {vertices, indices});
  const double step_m = p.real(models::kTerrainReliefM) / 65535;
  int within = 0, all = 0;
  for (const core::TerrainVertex& v : core::vertices_of<core::TerrainVertex>(vertices)) {
    if ((v.grid_x & core::kTerrainSkirtBit) != 0) continue;
    ++all;
    within += std::abs(int{v.height} - int{v.coarse_height}) * step_m <= error_m ? 1 : 0;
  }
  return within / static_cast<double>(all);
}

TEST(GroundError, HoldsForNearlyAllVerticesOfOtherNodes) {
  const world::World world = paper_world(standard_types());
  for (const int level : {0, 2, 5}) {
    const double error_m = measured_ground_error_m(SampleBlocks(world), standard_types(), level);
    double within = 0;
    constexpr int kNodes = 30;
    for (int i = 0; i < kNodes; ++i) {
      const core::BlockCoord block{17 * i, 511 - 13 * i};
      within += share_within(world, visibility::node_of(block, static_cast<std::uint8_t>(level)),
                             error_m);
    }
    EXPECT_NEAR(within / kNodes, 0.95, 0.04) << level;
  }
}

TEST(GroundError, GrowsWithTheHeightRangeAndIsZeroForFlatGround) {
  world::World world = paper_world(standard_types());
  const double usual_m = measured_ground_error_m(SampleBlocks(world), standard_types(), 1);
  EXPECT_GT(usual_m, 0);
  const double relief_m = world.terrain.real(models::kTerrainReliefM);
  world.terrain.set_real(models::kTerrainReliefM, 2 * relief_m);
  EXPECT_NEAR(measured_ground_error_m(SampleBlocks(world), standard_types(), 1), 2 * usual_m,
              0.1 * usual_m);
  world.terrain.set_real(models::kTerrainReliefM, 1);
  EXPECT_LT(measured_ground_error_m(SampleBlocks(world), standard_types(), 1), 0.1 * usual_m);
}

}  // namespace
}  // namespace psygen::scene
