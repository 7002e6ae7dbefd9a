#include "engine/scene/mesh_notes.hpp"

#include <algorithm>

#include "engine/models/terrain/terrain.hpp"
#include "engine/scene/draws/mesh_parts.hpp"

namespace psygen::scene {
namespace {

// The largest error of a node over the usual one.
constexpr double kPossibleError = 2.5;

GroundNote ground_of(const WorldFacts& facts, const synthesis::Request& request,
                     const models::MeshView& mesh) {
  const auto node_level = static_cast<int>(request.parameters.integer(models::kTerrainNodeLevel));
  const core::Bounds& bounds = facts.levels[static_cast<std::size_t>(node_level)].bounds;
  // The coarse ground of a block may give way to its finest, in the tick for which the lines hold.
  const float lower_by_m =
      node_level == 0 ? possible_error_m(facts, node_level, request.key.level) : 0.0F;
  const auto vertices = core::vertices_of<core::TerrainVertex>(mesh.vertices);
  const models::TerrainGrid& grid = facts.grids[request.key.level];
  return {ground_relief(vertices, grid, bounds.min.y, bounds.max.y - bounds.min.y, lower_by_m),
          ground_sun(vertices, static_cast<std::size_t>(grid.n))};
}

MeshParts parts_of(const WorldFacts& facts, const synthesis::Request& request,
                   const models::MeshView& mesh) {
  const core::Bounds box = facts.registry[facts.merged_model].bounds(request.parameters);
  return mesh_parts(core::vertices_of<core::ModelVertex>(mesh.vertices), mesh.indices,
                    core::Bounds::around(box.center(), box.half_extent()));  // as in Placed
}

}  // namespace

float possible_error_m(const WorldFacts& facts, int node_level, int mesh_level) {
  if (node_level == 0 && mesh_level == 0) return 0.0F;
  const NodeLevel& level = facts.levels[static_cast<std::size_t>(node_level)];
  return static_cast<float>(kPossibleError * level.ground_error_m);
}

std::vector<synthesis::Annotate> mesh_notes(const WorldFacts& facts) {
  const models::ModelIndex terrain = facts.world.terrain_model, merged = facts.merged_model;
  std::vector<synthesis::Annotate> notes(std::max(terrain, merged) + std::size_t{1});
  notes[terrain] = [&facts](const synthesis::Request& request, const models::MeshView& mesh) {
    return std::any(ground_of(facts, request, mesh));
  };
  if (merged != 0) {
    notes[merged] = [&facts](const synthesis::Request& request, const models::MeshView& mesh) {
      return std::any(parts_of(facts, request, mesh));
    };
  }
  return notes;
}

}  // namespace psygen::scene
