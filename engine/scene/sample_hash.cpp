#include "engine/scene/scene.hpp"
#include "engine/synthesis/content_hash.hpp"
#include "engine/synthesis/synthesize.hpp"

namespace psygen::scene {

std::uint64_t sample_world_hash(const world::World& world, const models::Registry& registry,
                                core::BlockCoord block) {
  synthesis::WorldHash hash;
  std::vector<world::Placement> placements;
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dx = -1; dx <= 1; ++dx) {
      const core::BlockCoord coord{block.x + dx, block.z + dz};
      placements.clear();
      if (!world.contains(coord)) continue;
      world::place_models(world, registry, coord, placements);
      placements.push_back({world.terrain_model, kTerrainIndex, glm::vec3(0.0F),
                            world::terrain_parameters(world, coord)});
      for (const world::Placement& placement : placements) {
        const models::ModelType& type = registry[placement.model];
        for (int level = 0; level < type.level_count(); ++level) {
          const auto mesh = synthesis::HeapDestination::make(type, placement.parameters, level);
          if (!mesh) continue;
          const models::MeshView view = mesh->view();
          if (!synthesis::synthesize_guarded(type, placement.parameters, level, view).ok) continue;
          hash.add(synthesis::content_hash(
              {coord, placement.index, placement.model, static_cast<std::uint16_t>(level),
               models::parameters_hash(type, placement.parameters)},
              view));
        }
      }
    }
  }
  return hash.value();
}

}  // namespace psygen::scene
