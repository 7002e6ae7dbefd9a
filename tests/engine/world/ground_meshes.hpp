// Meshes of a world's ground for tests: their vertices, seams and hashes.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/core/vertex_layout.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/world/placement.hpp"
#include "tests/engine/models/mesh_helpers.hpp"
#include "tests/engine/world/shipped.hpp"

namespace psygen::world::testing {

inline std::vector<core::TerrainVertex> mesh_of(const World& world, core::BlockCoord node,
                                                int level, int mesh_level) {
  return models::test::synthesise(registry()[world.terrain_model],
                                  terrain_parameters(world, node, level), mesh_level)
      .vertices<core::TerrainVertex>();
}

// Expects equal heights along both seams between a node and those east and south of it.
inline void expect_equal_seams(const World& world, core::BlockCoord node, int level) {
  const auto here = mesh_of(world, node, level, 0),
             east = mesh_of(world, {node.x + 1, node.z}, level, 0),
             south = mesh_of(world, {node.x, node.z + 1}, level, 0);
  const auto side = static_cast<std::size_t>(world.terrain.integer(models::kTerrainSize));
  for (std::size_t k = 0; k < side; ++k) {
    EXPECT_EQ(here[k * side + side - 1].height, east[k * side].height) << level;
    EXPECT_EQ(here[(side - 1) * side + k].height, south[k].height) << level;
  }
}

// Hashes of the keys of some meshes, and of the meshes themselves. Saves, ledgers and ranks compare
// them, so they must not change.
struct GroundHashes {
  std::uint64_t keys = 0, meshes = 0;
};
inline GroundHashes ground_hashes(const World& world) {
  const models::ModelType& terrain = registry()[world.terrain_model];
  GroundHashes hashes;
  for (const int level : {0, 1, 2, 4}) {
    for (const core::BlockCoord node : {core::BlockCoord{0, 0}, {2, 1}, {3, 3}, {-1, 0}}) {
      const models::Parameters p = terrain_parameters(world, node, level);
      hashes.keys = core::combine(hashes.keys, models::parameters_hash(terrain, p));
      for (const int mesh : {0, 1, 3})
        hashes.meshes = core::combine(
            hashes.meshes,
            core::hash_bytes(models::test::synthesise(terrain, p, mesh).vertex_bytes));
    }
  }
  return hashes;
}

}  // namespace psygen::world::testing
