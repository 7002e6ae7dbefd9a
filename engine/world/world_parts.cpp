#include "engine/world/world_parts.hpp"

#include <bit>
#include <span>

#include "engine/core/hash.hpp"
#include "engine/world/ground_blends.hpp"

namespace psygen::world {
namespace {

std::uint64_t with_real(std::uint64_t hash, double value) {
  return core::combine(hash, std::bit_cast<std::uint64_t>(value));
}

std::uint64_t hash_of_ground(const World& world, const models::Registry& registry) {
  const models::ModelType& terrain = registry[world.terrain_model];
  std::uint64_t hash = core::hash_bytes(std::as_bytes(std::span(terrain.name())));
  models::Parameters ground = world.terrain;
  ground.set_edits(nullptr, 0);
  for (const std::uint64_t part :
       {world.seed, static_cast<std::uint64_t>(world.blocks_x),
        static_cast<std::uint64_t>(world.blocks_z), models::parameters_hash(terrain, ground),
        shape_hash(world), placing_hash(world)})
    hash = core::combine(hash, part);
  return hash;
}

// `first`: the index of the scatter's first instance in a block; `level_m`: of the sea.
std::uint64_t hash_of_places(const models::ModelType& type, const Scatter& scatter,
                             std::uint32_t first, std::uint64_t ground, double level_m) {
  std::uint64_t hash = core::hash_bytes(std::as_bytes(std::span(type.name())), ground);
  hash = core::combine(core::combine(hash, first), scatter.count);
  for (const double limit : {scatter.min_height_m, scatter.max_height_m, scatter.max_slope_deg})
    hash = with_real(hash, limit);
  if (const std::uint64_t site = site_hash(scatter.site); site != 0)
    hash = core::combine(hash, site);
  if (scatter.limits_depth() || scatter.water_reach_m() > 0)
    for (const double limit : {scatter.max_depth_m, scatter.near_water_m, level_m})
      hash = with_real(hash, limit);
  for (const double rule : {scatter.spacing_m, scatter.footprint_m})
    if (rule > 0) hash = with_real(hash, rule);
  return core::combine(hash, mask_hash(scatter.mask));
}

std::uint64_t hash_of_models(const World& world, const models::Registry& registry,
                             const Scatter& scatter, std::uint32_t first) {
  const models::ModelType& type = registry[scatter.model];
  std::uint64_t hash = core::hash_bytes(std::as_bytes(std::span(type.name())));
  for (const std::uint64_t part : {world.seed, std::uint64_t{first}, std::uint64_t{scatter.count},
                                   models::parameters_hash(type, models::default_parameters(type))})
    hash = core::combine(hash, part);
  for (const ParameterRange& range : scatter.ranges)
    hash = with_real(with_real(hash, range.low), range.high);
  if (scatter.site.edge_size < 1)
    hash = core::combine(with_real(with_real(hash, scatter.site.edge_size), world.block_size_m()),
                         mask_hash(scatter.mask));
  return scatter.tilt < 1 ? with_real(hash, scatter.tilt) : hash;
}

}  // namespace

WorldParts parts_of(const World& world, const models::Registry& registry) {
  WorldParts parts;
  parts.ground = hash_of_ground(world, registry);
  std::uint32_t first = 0;
  for (const Scatter& scatter : world.scatter) {
    parts.places.push_back(
        hash_of_places(registry[scatter.model], scatter, first, parts.ground, world.water.level_m));
    parts.models.push_back(hash_of_models(world, registry, scatter, first));
    first += scatter.count;
  }
  // Instances that keep apart, or stand beside such ones, depend on all that do.
  std::uint64_t apart = 0;
  for (std::size_t s = 0; s < world.scatter.size(); ++s)
    if (world.scatter[s].keeps_apart()) apart = core::combine(apart, parts.places[s]);
  for (std::size_t s = 0; s < world.scatter.size(); ++s)
    if (world.scatter[s].keeps_apart() || world.scatter[s].is_beside())
      parts.places[s] = core::combine(parts.places[s], apart);
  return parts;
}

}  // namespace psygen::world
