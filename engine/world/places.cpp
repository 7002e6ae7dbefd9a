#include "engine/world/places.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <span>

#include "engine/models/edits.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {
namespace {

models::PlacedModel placed_model(const Place& place, const models::ModelType& type,
                                 std::uint32_t id, const core::WorldPosition& at, float size_m) {
  const auto within = [size_m](double local_m) {
    return std::min(static_cast<float>(local_m), std::nextafter(size_m, 0.0F));
  };
  models::PlacedModel placed{.id = id,
                             .local_m = {within(at.local.x), within(at.local.z)},
                             .above_m = static_cast<float>(place.above_m),
                             .parameters = place.parameters};
  models::bind(placed, type);
  return placed;
}

}  // namespace

void sort_places(World& world, const models::Registry& registry) {
  world.places.by_block = nullptr;
  if (world.places.all.empty()) return;
  const double size_m = world.block_size_m();
  std::map<core::BlockCoord, models::BlockEdits> blocks;
  std::uint32_t id = 0;
  for (const Place& place : world.places.all) {
    const core::WorldPosition at = world.position(place.at_m);
    blocks[at.block].placed.push_back(
        placed_model(place, registry[place.model], ++id, at, static_cast<float>(size_m)));
  }
  auto layer = std::make_shared<models::EditLayer>();
  for (auto& [block, edits] : blocks)
    layer->blocks.set(models::QuadCoord::of(block), std::move(edits));
  world.places.by_block = std::move(layer);
}

std::uint64_t places_hash(const World& world, const models::Registry& registry) {
  if (world.places.all.empty()) return 0;
  std::uint64_t hash = world.places.all.size();
  for (const Place& place : world.places.all) {
    hash = core::combine(hash,
                         core::hash_bytes(std::as_bytes(std::span(registry[place.model].name()))));
    hash = core::combine(hash, place.parameters.hash());
    for (const double v : {place.at_m.x, place.at_m.y, place.above_m})
      hash = core::combine(hash, std::bit_cast<std::uint64_t>(v + 0.0));
  }
  return std::max<std::uint64_t>(hash, 1);
}

}  // namespace psygen::world
