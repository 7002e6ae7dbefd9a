#include "engine/scene/nodes/columns.hpp"

#include <algorithm>

#include "engine/scene/nodes/mesh_entity.hpp"
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

}  // namespace

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

world::Placement merged_placement(const WorldFacts& facts, const visibility::NodeCoord& at) {
  return {facts.merged_model, kMergedIndex, glm::vec3(0.0F),
          world::merged_parameters(facts.world, at.coord, at.level)};
}

}  // namespace psygen::scene
