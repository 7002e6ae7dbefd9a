#include "engine/scene/meshes/mesh_annotations.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <memory>

#include "engine/models/edits.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/scene/facts/world_facts.hpp"
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

// The number of triangles up to the last one with three different corners.
std::size_t used_triangles(std::span<const std::uint16_t> indices) {
  std::size_t count = indices.size() / 3;
  const auto empty = [&](std::size_t t) {
    const std::uint16_t a = indices[3 * t], b = indices[3 * t + 1], c = indices[3 * t + 2];
    return a == b || b == c || c == a;
  };
  while (count > 0 && empty(count - 1))
    --count;
  return count;
}

core::Bounds box_of(std::span<const core::ModelVertex> vertices,
                    std::span<const std::uint16_t> indices, const core::Bounds& box) {
  glm::ivec3 low(INT16_MAX), high(INT16_MIN);
  float reach_m = 0;
  for (const std::uint16_t index : indices) {
    const core::ModelVertex& v = vertices[index];
    const glm::ivec3 place(v.position[0], v.position[1], v.position[2]);
    low = glm::min(low, place);
    high = glm::max(high, place);
    reach_m = std::max(reach_m, core::billboard_reach_m(v));
  }
  const glm::vec3 scale = box.half_extent() / 32767.0F;
  const glm::vec3 around(reach_m, 0, reach_m);
  return {box.centre() + glm::vec3(low) * scale - around,
          box.centre() + glm::vec3(high) * scale + around};
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

MeshParts mesh_parts(std::span<const core::ModelVertex> vertices,
                     std::span<const std::uint16_t> indices, const core::Bounds& box) {
  MeshParts parts;
  const std::size_t triangles = used_triangles(indices);
  parts.index_count = static_cast<std::uint32_t>(3 * triangles);
  const std::size_t each =
      std::max<std::size_t>((triangles + MeshParts::kMax - 1) / MeshParts::kMax, 1);
  parts.indices_each = static_cast<std::uint32_t>(3 * each);
  for (std::size_t first = 0; first < triangles; first += each) {
    const std::size_t count = std::min(each, triangles - first);
    parts.boxes[parts.count++] = box_of(vertices, indices.subspan(3 * first, 3 * count), box);
  }
  return parts;
}

}  // namespace psygen::scene
