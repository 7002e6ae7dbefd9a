#include "engine/world/world.hpp"

#include <cmath>
#include <glm/trigonometric.hpp>

#include "engine/models/terrain.hpp"

namespace psygen::world {

glm::vec3 Sky::sun_direction() const {
  const double azimuth = glm::radians(sun_azimuth_deg), elevation = glm::radians(sun_elevation_deg);
  return {static_cast<float>(std::sin(azimuth) * std::cos(elevation)),
          static_cast<float>(std::sin(elevation)),
          static_cast<float>(-std::cos(azimuth) * std::cos(elevation))};
}

double World::block_size_m() const {
  return models::terrain_block_size_m(terrain);
}

double World::cell_m() const {
  return terrain.real(models::kTerrainCellM);
}

bool World::contains(core::BlockCoord block) const {
  const auto inside = [](std::int32_t index, std::int64_t count) {
    return count == 0 || (index >= 0 && index < count);
  };
  return inside(block.x, blocks_x) && inside(block.z, blocks_z);
}

}  // namespace psygen::world
