#include "engine/scene/nodes/mesh_entity.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace psygen::scene {

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

}  // namespace psygen::scene
