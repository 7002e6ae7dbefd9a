#include "engine/save/world_identity.hpp"

#include <span>

#include "engine/core/hash.hpp"
#include "engine/world/files/world_file.hpp"

namespace psygen::save {

WorldIdentity identity_of(const world::World& world, const models::Registry& registry) {
  world::World bare = world;
  bare.name.clear();
  bare.sky = {};
  bare.palette = {};
  const std::string text = world::write_world(bare, registry);
  return {world.name, core::hash_bytes(std::as_bytes(std::span(text)))};
}

}  // namespace psygen::save
