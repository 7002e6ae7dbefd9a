#include "engine/query/block_source.hpp"

#include <limits>

#include "engine/core/hash.hpp"
#include "engine/models/edits.hpp"
#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/terrain.hpp"

namespace psygen::query {

std::vector<std::uint16_t> ground_of_block(const world::World& world, core::BlockCoord block) {
  const auto size = static_cast<std::size_t>(world.terrain.integer(models::kTerrainSize));
  std::vector<std::uint16_t> heights(size * size);
  models::BlockGround(world::terrain_parameters(world, block), block, heights.size())
      .heights(heights);
  return heights;
}

std::vector<world::Placement> models_of_block(const world::World& world,
                                              const models::Registry& registry,
                                              core::BlockCoord block) {
  std::vector<world::Placement> models;
  models.reserve(world::models_per_block(world));
  world::place_models(world, registry, block, models);
  models.shrink_to_fit();
  return models;
}

std::uint64_t edits_of_block(const world::World& world, core::BlockCoord block) {
  if (!world.edits) return 0;
  const models::BlockEdits* const edits = world.edits->block(block);
  const std::uint64_t ground = world.edits->ground.own().hash_of(
      models::QuadCoord::of(block), world::ground_margin(world, 0), world.block_size_m());
  if (ground == 0 && edits == nullptr) return 0;
  return core::combine(ground, edits != nullptr ? edits->hash() : 0);
}

}  // namespace psygen::query
