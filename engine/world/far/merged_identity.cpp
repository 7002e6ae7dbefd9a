#include "engine/world/far/merged_identity.hpp"

#include <bit>

#include "engine/world/far/merged_models.hpp"
#include "engine/world/ground_blends.hpp"

namespace psygen::world {
namespace {

using models::ParameterSpec;

constexpr std::uint64_t kEdition = 4;  // version of the meshes of merged_models.cpp

constexpr ParameterSpec kSchema[kMergedParameterCount] = {
    models::placed(models::integer_parameter("block_x", "nodes", 0,
                                             models::HardRange{-0x1.0p31, 0x1.0p31 - 1},
                                             models::SoftRange{-1000, 1000}, "node along x")),
    models::placed(models::integer_parameter("block_z", "nodes", 0,
                                             models::HardRange{-0x1.0p31, 0x1.0p31 - 1},
                                             models::SoftRange{-1000, 1000}, "node along z")),
    models::placed(models::integer_parameter(
        "node_level", "", 1, models::HardRange{1, kMaxMergedLevel},
        models::SoftRange{1, kMaxMergedLevel}, "the node is 2^node_level blocks wide and long")),
};

}  // namespace

std::span<const ParameterSpec> merged_schema() {
  return kSchema;
}

std::uint64_t merged_identity(const World& world, const models::Registry& registry) {
  std::uint64_t h = core::combine(kEdition, world.seed);
  const auto add = [&h](std::uint64_t v) { h = core::combine(h, v); };
  const auto add_real = [&add](double v) { add(std::bit_cast<std::uint64_t>(v)); };
  add(static_cast<std::uint64_t>(world.blocks_x));
  add(static_cast<std::uint64_t>(world.blocks_z));
  add(models::parameters_hash(registry[world.terrain_model], world.terrain));
  for (const Scatter& s : world.scatter) {
    const models::ModelType& type = registry[s.model];
    add(core::hash_bytes(std::as_bytes(std::span(type.name()))));
    add(models::parameters_hash(type, models::default_parameters(type)));
    add(s.count);
    for (const ParameterRange& range : s.ranges) {
      add_real(range.low);
      add_real(range.high);
    }
    add_real(s.min_height_m);
    add_real(s.max_height_m);
    add_real(s.max_slope_deg);
    if (const std::uint64_t mask = mask_hash(s.mask); mask != 0) add(mask);
  }
  if (const std::uint64_t shape = shape_hash(world); shape != 0) add(shape);
  if (const std::uint64_t places = places_hash(world, registry); places != 0) {
    add(places);
    for (const Place& place : world.places.all)
      add(registry[place.model].identity());
  }
  if (const std::uint64_t ground = placing_hash(world); ground != 0) add(ground);
  return h;
}

std::shared_ptr<const World> without_edits(std::shared_ptr<const World> world) {
  if (!world->edits) return world;
  auto copy = std::make_shared<World>(*world);
  set_edits(*copy, nullptr);
  return copy;
}

}  // namespace psygen::world
