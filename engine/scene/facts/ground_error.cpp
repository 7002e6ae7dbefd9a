#include "engine/scene/facts/ground_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/core/vertex_layout.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/scene/facts/levels.hpp"
#include "engine/visibility/quadtree.hpp"

namespace psygen::scene {
namespace {

constexpr int kNodes = 16;           // measured nodes of each level
constexpr double kUsualPlaces = 95;  // percent

// Adds the distance of each vertex from the next coarser surface, in units of 1/65535 of the height
// range. Every second vertex of every second row lies on that surface.
void add_distances(std::span<const core::TerrainVertex> vertices,
                   std::vector<std::uint16_t>& distances) {
  for (const core::TerrainVertex& v : vertices) {
    if ((v.grid_x & core::kTerrainSkirtBit) != 0) continue;
    distances.push_back(static_cast<std::uint16_t>(std::abs(int{v.height} - int{v.coarse_height})));
  }
}

}  // namespace

double measured_ground_error_m(const world::World& world, const models::Registry& registry,
                               int node_level) {
  const models::ModelType& terrain = registry[world.terrain_model];
  core::RandomStream random(world.seed, 0, 0, static_cast<std::uint32_t>(node_level),
                            core::Purpose::kParameters);
  std::vector<std::byte> vertices;
  std::vector<std::uint16_t> indices;
  std::vector<std::uint16_t> distances;
  for (int i = 0; i < kNodes; ++i) {
    const visibility::NodeCoord node =
        visibility::node_of(any_block(world, random), static_cast<std::uint8_t>(node_level));
    const models::Parameters p = node_terrain(world, node);
    const models::MeshSize size = terrain.mesh_size(p, 0);
    vertices.resize(size.vertex_count * sizeof(core::TerrainVertex));
    indices.resize(size.own_index_count());
    terrain.synthesise(p, 0, {vertices, indices});
    add_distances(core::vertices_of<core::TerrainVertex>(vertices), distances);
  }
  const auto usual =
      distances.begin() +
      static_cast<std::ptrdiff_t>(static_cast<double>(distances.size() - 1) * kUsualPlaces / 100);
  std::nth_element(distances.begin(), usual, distances.end());
  return *usual / 65535.0 * world.terrain.real(models::kTerrainReliefM);
}

}  // namespace psygen::scene
