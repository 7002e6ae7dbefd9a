#include "engine/scene/nodes/mesh_entity.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "engine/world/far/merged_models.hpp"
#include "engine/world/far/tree_impostors.hpp"

namespace psygen::scene {
namespace {

// The level that is an impostor; the type's coarser levels are not used then. 0: none.
int picture_level_of(const WorldFacts& facts, const world::Placement& placement) {
  const models::ModelIndex model = placement.model;
  if (model >= facts.quad_models.size() || facts.quad_models[model] == 0) return 0;
  const int level = facts.pictures->first_level(model, placement.parameters);
  const int count = facts.registry[model].level_count_of(placement.parameters);
  return level < std::min(count, static_cast<int>(kMaxLevels)) ? level : 0;
}

// `typical`: the part of the bounds that its mesh usually fills (WorldFacts::typical_bounds).
MeshPlacement placed_at(core::BlockCoord block, glm::vec3 position, const core::Bounds& box,
                        const core::Bounds& typical) {
  MeshPlacement placed;
  placed.block = block;
  placed.position = position;
  placed.box_centre = box.centre();
  placed.box_half_extent = box.half_extent();
  placed.middle = placed.box_centre + placed.box_half_extent * typical.centre();
  placed.radius_m = glm::length(placed.box_half_extent * typical.half_extent());
  return placed;
}

// Levels `first` … `last` of a model type, without repeated ones.
LodErrors detail_of(const models::ModelType& type, const models::Parameters& parameters, int first,
                    int last) {
  LodErrors detail;
  detail.seen_size_m = static_cast<float>(type.seen_size_m(parameters));
  detail.leaves = type.surface() == core::SurfaceKind::kBark;
  for (int level = first; level <= std::min(last, type.level_count_of(parameters) - 1); ++level) {
    if (detail.level_count == kMaxLevels) break;
    detail.error_m[detail.level_count++] =
        static_cast<float>(type.level_error_m(parameters, level));
  }
  return detail;
}

}  // namespace

synthesis::MeshKey key_of(const MeshPlacement& placed, const LodErrors& detail,
                          const MeshSource& source, std::uint8_t level) {
  const bool picture = level == detail.picture_level;
  return {placed.block, source.index, picture ? source.picture_model : source.model,
          static_cast<std::uint16_t>(picture ? 0 : source.first_level + level),
          hash_of(source, picture)};
}

std::uint64_t hash_of(const MeshSource& source, bool picture) {
  return picture ? core::combine(source.parameters_hash, source.picture_set)
                 : source.parameters_hash;
}

std::uint8_t level_of(const LodErrors& detail, const MeshSource& source,
                      const synthesis::MeshKey& key) {
  const bool picture = source.picture_model != 0 && key.model == source.picture_model;
  return static_cast<std::uint8_t>(picture ? detail.picture_level : key.level - source.first_level);
}

float distance_to(const MeshPlacement& placed, const glm::vec3& foot, float min_m) {
  return std::max(glm::length(foot + placed.middle) - placed.radius_m, min_m);
}

float size_pixels(const MeshPlacement& placed, const LodErrors& detail, float distance_m,
                  float pixels_per_radian, float min_m) {
  const float size_m = detail.seen_size_m > 0 ? detail.seen_size_m : 2 * placed.radius_m;
  return size_m * pixels_per_radian / std::max(distance_m + placed.radius_m, min_m);
}

MeshColumns columns_of(const WorldFacts& facts, core::BlockCoord block,
                       const world::Placement& placement, int first_level, int last_level) {
  const models::ModelType& type = facts.registry[placement.model];
  const int picture_level = picture_level_of(facts, placement);
  if (picture_level > 0) last_level = picture_level;
  MeshColumns columns{placed_at(block, placement.position, type.bounds(placement.parameters),
                                facts.typical_bounds[placement.model]),
                      detail_of(type, placement.parameters, first_level, last_level),
                      {placement.parameters, models::parameters_hash(type, placement.parameters),
                       placement.index, placement.model, static_cast<std::uint16_t>(first_level)}};
  columns.placed.surface = type.surface();
  if (placement.model < facts.quad_models.size())
    columns.source.picture_model = facts.quad_models[placement.model];
  if (columns.source.picture_model != 0)
    columns.source.picture_set =
        static_cast<std::uint32_t>(facts.pictures->identity_of_quads(placement.model));
  if (picture_level > 0) columns.detail.picture_level = static_cast<std::uint16_t>(picture_level);
  return columns;
}

bool has_merged(const WorldFacts& facts, const visibility::NodeCoord& at) {
  return at.level > 0 &&
         (facts.levels[at.level].merged || world::has_placed(facts.world, at.coord, at.level));
}

world::Placement merged_placement(const WorldFacts& facts, const visibility::NodeCoord& at) {
  return {facts.merged_model, kMergedIndex, glm::vec3(0.0F),
          world::merged_parameters(facts.world, at.coord, at.level)};
}

std::optional<world::Placement> water_placement(const WorldFacts& facts,
                                                const visibility::NodeCoord& at) {
  const auto parameters = world::water_parameters(facts.world, at.coord, at.level);
  if (!parameters) return std::nullopt;
  return world::Placement{facts.water_model, kWaterIndex, glm::vec3(0.0F), *parameters};
}

}  // namespace psygen::scene
