#include "engine/world/world.hpp"

#include "engine/models/terrain.hpp"

namespace psygen::world {

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
