#include "engine/scene/meshes/mesh_annotations.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "engine/models/edits.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/meshes/mesh_parts.hpp"
#include "engine/world/far/tree_impostors.hpp"

namespace psygen::scene {
namespace {

// Measured errors do not include edits: a tower may stand between two vertices.
float edits_error_m(const WorldFacts& facts, const synthesis::Request& request) {
  const models::Parameters& p = request.parameters;
  const auto level = static_cast<int>(p.integer(models::kTerrainNodeLevel));
  if (p.edits() == nullptr || (level == 0 && request.key.level == 0)) return 0.0F;
  const core::BlockCoord node{static_cast<std::int32_t>(p.integer(models::kTerrainBlockX)),
                              static_cast<std::int32_t>(p.integer(models::kTerrainBlockZ))};
  const double spacing_m =
      std::ldexp(static_cast<double>(facts.cell_m) * facts.grids[request.key.level].stride, level);
  const double error_m =
      p.edits()->ground.error_m(models::QuadCoord::of(node, static_cast<std::uint32_t>(level)),
                                spacing_m, facts.levels[0].size_m);
  return static_cast<float>(std::min(error_m, p.real(models::kTerrainReliefM)));
}

GroundAnnotation ground_of(const WorldFacts& facts, const synthesis::Request& request,
                           const models::MeshView& mesh) {
  const auto node_level = static_cast<int>(request.parameters.integer(models::kTerrainNodeLevel));
  const core::Bounds& bounds = facts.levels[static_cast<std::size_t>(node_level)].bounds;
  const float edits_m = edits_error_m(facts, request);
  // The finest ground of a block may replace the coarse one in the tick for which the lines hold.
  const float lower_by_m =
      node_level == 0 ? possible_error_m(facts, node_level, request.key.level) + edits_m : 0.0F;
  const auto vertices = core::vertices_of<core::TerrainVertex>(mesh.vertices);
  const models::TerrainGrid& grid = facts.grids[request.key.level];
  return {ground_occluder(vertices, grid, bounds.min.y, bounds.max.y - bounds.min.y, lower_by_m),
          ground_sunlight(vertices, static_cast<std::size_t>(grid.n)), edits_m};
}

MeshParts parts_of(const WorldFacts& facts, const synthesis::Request& request,
                   const models::MeshView& mesh) {
  const core::Bounds box = facts.registry[facts.merged_model].bounds(request.parameters);
  return mesh_parts(core::vertices_of<core::ModelVertex>(mesh.vertices), mesh.indices,
                    core::Bounds::around(box.centre(), box.half_extent()));  // as in MeshPlacement
}

}  // namespace

float possible_error_m(const WorldFacts& facts, int node_level, int mesh_level) {
  if (node_level == 0 && mesh_level == 0) return 0.0F;
  const NodeLevel& level = facts.levels[static_cast<std::size_t>(node_level)];
  return static_cast<float>(level.ground_bound_m);
}

std::vector<synthesis::Annotate> mesh_annotations(const WorldFacts& facts) {
  const models::ModelIndex terrain = facts.world.terrain_model, merged = facts.merged_model;
  const models::ModelIndex picture = facts.picture_model;
  std::vector<synthesis::Annotate> notes(std::max({terrain, merged, picture}) + std::size_t{1});
  notes[terrain] = [&facts](const synthesis::Request& request, const models::MeshView& mesh) {
    return std::any(ground_of(facts, request, mesh));
  };
  if (merged != 0) {
    notes[merged] = [&facts](const synthesis::Request& request, const models::MeshView& mesh) {
      return std::any(parts_of(facts, request, mesh));
    };
  }
  if (picture != 0) {
    notes[picture] = [pictures = facts.pictures](const synthesis::Request& request,
                                                 const models::MeshView&) {
      const std::size_t number = world::picture_number(request.parameters);
      return std::any(std::make_shared<const core::ImpostorTexture>(pictures->bake(number)));
    };
  }
  return notes;
}

}  // namespace psygen::scene
