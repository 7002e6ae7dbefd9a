#include "engine/world/world.hpp"

#include <algorithm>
#include <utility>

#include "engine/models/edits.hpp"
#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/terrain.hpp"

namespace psygen::world {

double World::block_size_m() const {
  return models::terrain_block_size_m(terrain);
}

double World::cell_m() const {
  return terrain.real(models::kTerrainCellM);
}

double surface_height_m(const World& world, const core::WorldPosition& at) {
  const double ground_m = models::ground_height_m(world.terrain, at.block, at.local.x, at.local.z);
  return world.water.exists() ? std::max(ground_m, world.water.level_m) : ground_m;
}

void set_edits(World& world, std::shared_ptr<const models::EditLayer> edits) {
  static const models::EditLayer none;
  const models::EditLayer& below = world.shaped.layer ? *world.shaped.layer : none;
  if (edits && !edits->ground.lies_on(below.ground)) {
    models::EditLayer layer = *edits;
    layer.ground = layer.ground.over(below.ground);
    edits = std::make_shared<const models::EditLayer>(std::move(layer));
  }
  world.edits = std::move(edits);
  // Without a hash: only for a node is it known which edits matter (placement.hpp).
  world.terrain.set_edits(world.layer().get(), 0);
}

Palette drawn_palette(const World& world) {
  Palette palette = world.palette;
  if (world.water.exists())
    palette.sand_end_m = std::max(palette.sand_end_m, world.water.level_m + world.water.shore_m);
  return palette;
}

bool World::contains(core::BlockCoord block) const {
  const auto inside = [](std::int32_t index, std::int64_t count) {
    return count == 0 || (index >= 0 && index < count);
  };
  return inside(block.x, blocks_x) && inside(block.z, blocks_z);
}

}  // namespace psygen::world
