#include "engine/world/placement.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>
#include <vector>

#include "engine/core/assert.hpp"
#include "engine/core/rounding.hpp"
#include "engine/models/edits.hpp"
#include "engine/models/terrain/terrain.hpp"
#include "engine/models/water/water_surface.hpp"
#include "engine/world/spacing.hpp"

namespace psygen::world {
namespace {

// True if edits may change heights in a block, or where its instances look beyond it.
bool has_edited_ground(const World& world, core::BlockCoord block) {
  if (!world.edits) return false;
  const double block_m = world.block_size_m();
  return world.edits->ground.edits.hash_of(models::QuadCoord::of(block),
                                           ground_reach_m(world) / block_m, block_m) != 0;
}

// The ground on which instances find their positions, and the ground on which they stand.
struct Grounds {
  const models::BlockGround &base, &shown;
  double block_m;
};

// Moves an instance from the base to the shown ground. A foot that crosses the block's border stays
// on the base ground, so that an edit beyond the border changes nothing here.
void stand_on_edits(const Grounds& grounds, const Scatter& scatter, Foothold& place) {
  const glm::dvec2 at_m(place.position.x, place.position.z);
  const models::GroundPoint point = grounds.shown.at(at_m);
  const double half_m = scatter.footprint_m / 2;
  const bool is_inside =
      std::min(at_m.x, at_m.y) >= half_m && std::max(at_m.x, at_m.y) <= grounds.block_m - half_m;
  place.normal = point.normal;
  if (half_m <= 0)
    place.position.y = static_cast<float>(point.height_m);
  else if (is_inside)
    place.position.y = static_cast<float>(grounds.shown.lowest_m(at_m, half_m));
  else
    place.position.y = std::min(place.position.y, static_cast<float>(point.height_m));
}

// The placements of the world's function that were not removed. `wanted` selects scatters; null:
// all.
void place_instances(const World& world, const models::Registry& registry, core::BlockCoord block,
                     const Grounds& grounds, const models::BlockEdits* edits,
                     const std::vector<bool>* wanted, std::vector<Placement>& out) {
  BlockObstacles obstacles(world, block);
  std::uint32_t first = 0;
  for (std::size_t s = 0; s < world.scatter.size(); first += world.scatter[s++].count) {
    if (wanted != nullptr && !(*wanted)[s]) continue;
    const Scatter& scatter = world.scatter[s];
    std::uint32_t index = first;
    const Scattering scattering(world, registry[scatter.model], scatter, obstacles);
    for (std::uint32_t k = 0; k < scatter.count; ++k, ++index) {
      if (edits != nullptr && edits->is_removed(index)) continue;
      auto place = scattering.place(grounds.base, index);
      if (!place) continue;
      if (&grounds.base != &grounds.shown) stand_on_edits(grounds, scatter, *place);
      out.push_back(
          {scatter.model, index, place->position, scattering.parameters(index, place->normal)});
    }
  }
}

void place_by_hand(const models::BlockEdits& edits, const models::Registry& registry,
                   const models::BlockGround& ground, std::uint32_t first_index,
                   std::vector<Placement>& out) {
  for (const models::PlacedModel& placed : edits.placed) {
    const auto model = models::type_of(placed, registry);
    if (!model) continue;
    const models::GroundPoint point = ground.at(placed.local_m);
    const models::ModelType& type = registry[*model];
    Placement placement{
        *model,
        first_index + placed.id,
        {placed.local_m.x, static_cast<float>(point.height_m) + placed.above_m, placed.local_m.y},
        placed.parameters};
    set_slope(type, slope_parameters(type),
              glm::vec2(point.normal.x, point.normal.z) / -point.normal.y, placement.parameters);
    out.push_back(placement);
  }
}

void place_wanted(const World& world, const models::Registry& registry, core::BlockCoord block,
                  const models::BlockGround& ground, const std::vector<bool>* wanted,
                  std::vector<Placement>& out) {
  const core::RoundToNearest rounding;
  out.clear();
  const models::BlockEdits* const edits = world.edits ? world.edits->block(block) : nullptr;
  const double block_m = world.block_size_m();
  if (has_edited_ground(world, block)) {
    const models::BlockGround base(unedited_terrain(world), block, models_per_block(world));
    place_instances(world, registry, block, {base, ground, block_m}, edits, wanted, out);
  } else {
    place_instances(world, registry, block, {ground, ground, block_m}, edits, wanted, out);
  }
  if (edits != nullptr) place_by_hand(*edits, registry, ground, kPlacedIndex, out);
  if (!world.places.by_block) return;
  if (const models::BlockEdits* const of_file = world.places.by_block->block(block))
    place_by_hand(*of_file, registry, ground, kFilePlacedIndex, out);
}

}  // namespace

Scattering::Scattering(const World& world, const models::ModelType& type, const Scatter& scatter,
                       BlockObstacles& block)
    : seed_(world.seed),
      type_(type),
      scatter_(scatter),
      specs_(type.parameters()),
      defaults_(models::default_parameters(type)),
      obstacles_(block),
      search_(world, scatter, block),
      slope_(slope_parameters(type)) {}

std::optional<Foothold> Scattering::place(const models::BlockGround& ground, std::uint32_t index,
                                          glm::dvec2 corner_m) const {
  auto found = search_.find(ground, index, corner_m);
  if (!found) return found;
  const glm::dvec2 at_m(found->position.x, found->position.z);
  if (scatter_.keeps_apart() && obstacles_.others().is_crowded(index, ground, corner_m))
    return std::nullopt;
  if (scatter_.footprint_m > 0)
    found->position.y =
        static_cast<float>(ground.lowest_m(corner_m + at_m, scatter_.footprint_m / 2));
  return found;
}

models::Parameters Scattering::parameters(std::uint32_t index, const glm::vec3& normal) const {
  models::Parameters p = defaults_;
  core::RandomStream values(seed_, obstacles_.block().x, obstacles_.block().z, index,
                            core::Purpose::kParameters);
  core::RandomStream seeds(seed_, obstacles_.block().x, obstacles_.block().z, index,
                           core::Purpose::kSeed);
  const double edge = scatter_.site.edge_size;
  const double size = edge < 1 ? std::lerp(edge, 1.0, search_.mask_share(index)) : 1;
  for (std::size_t i = 0; i < specs_.size(); ++i) {
    ParameterRange range = scatter_.ranges[i];
    if (size < 1 && specs_[i].unit == "m") range.high = range.low + size * (range.high - range.low);
    if (specs_[i].source == models::ParameterSource::kPlaced) {
      if (specs_[i].name == "seed") p.set_integer(i, std::bit_cast<std::int64_t>(seeds.next_u64()));
    } else if (specs_[i].type == models::ParameterType::kInteger) {
      p.set_integer(i, values.next_integer(std::llround(range.low), std::llround(range.high)));
    } else {
      // Always draws one number per parameter, so a changed range does not affect the others.
      const double drawn = values.next_real(range.low, range.high);
      p.set_real(i, range.low == range.high ? range.low : std::min(drawn, range.high));
    }
  }
  set_slope(type_, slope_,
            static_cast<float>(scatter_.tilt) * (glm::vec2(normal.x, normal.z) / -normal.y), p);
  return p;
}

void set_sun(models::Parameters& terrain, double azimuth_deg, double elevation_deg) {
  const double elevation =
      std::max(std::round(elevation_deg / kSunElevationStep) * kSunElevationStep, 0.0);
  const double azimuth = std::round(azimuth_deg / kSunAzimuthStep) * kSunAzimuthStep;
  const double turns = std::floor(azimuth / 360);
  const bool casts_shadows = elevation > 0 && elevation < 90;
  terrain.set_real(models::kTerrainSunAzimuth, casts_shadows ? azimuth - 360 * turns : 0.0);
  terrain.set_real(models::kTerrainSunElevation, std::min(elevation, 90.0));
}

models::Parameters terrain_parameters(const World& world, core::BlockCoord node, int node_level) {
  models::Parameters p = unedited_terrain(world);
  p.set_integer(models::kTerrainSeed, std::bit_cast<std::int64_t>(world.seed));
  p.set_integer(models::kTerrainBlockX, node.x);
  p.set_integer(models::kTerrainBlockZ, node.z);
  p.set_integer(models::kTerrainNodeLevel, node_level);
  set_sun(p, world.sky.sun_azimuth_deg, world.sky.sun_elevation_deg);
  p.set_edits(nullptr, 0);
  const models::EditLayer* const layer = world.layer().get();
  if (layer == nullptr) return p;
  const auto at = models::QuadCoord::of(node, static_cast<std::uint32_t>(node_level));
  const std::uint64_t hash =
      layer->ground.hash_of(at, ground_margin(world, node_level), world.block_size_m());
  if (hash != 0) p.set_edits(layer, hash);
  return p;
}

std::optional<models::Parameters> water_parameters(const World& world, core::BlockCoord node,
                                                   int node_level) {
  const models::EditLayer* const layer = world.layer().get();
  if (layer == nullptr) return std::nullopt;
  const double block_m = world.block_size_m();
  models::Parameters p = models::water_surface_parameters(node, node_level, block_m);
  const auto at = models::QuadCoord::of(node, static_cast<std::uint32_t>(node_level));
  p.set_edits(layer, layer->ground.hash_of(at, 0, block_m));
  if (!models::has_water_surface(p)) return std::nullopt;
  return p;
}

std::vector<std::uint16_t> ground_of_block(const World& world, core::BlockCoord block) {
  const auto size = static_cast<std::size_t>(world.terrain.integer(models::kTerrainSize));
  std::vector<std::uint16_t> heights(size * size);
  models::BlockGround(terrain_parameters(world, block), block, heights.size()).heights(heights);
  return heights;
}

double ground_margin(const World& world, int node_level) {
  const auto size = static_cast<int>(world.terrain.integer(models::kTerrainSize));
  const double cells = models::terrain_strides(size)[1] + 1;
  return std::ldexp(cells / static_cast<double>(size - 1), node_level);
}

double ground_reach_m(const World& world) {
  double farthest_m = 0, widest_m = 0, beside_m = 0;
  for (const Scatter& scatter : world.scatter) {
    farthest_m = std::max({farthest_m, scatter.water_reach_m(), scatter.footprint_m / 2});
    widest_m = std::max(widest_m, scatter.spacing_m);
  }
  // One beside another, which stands beside a third, and so on.
  for (const Scatter& scatter : world.scatter)
    if (scatter.is_beside()) beside_m += scatter.site.beside_m + widest_m;
  const double block_m = world.block_size_m();
  return farthest_m + std::ceil((widest_m + beside_m) / block_m) * block_m;
}

std::size_t models_per_block(const World& world) {
  std::size_t count = 0;
  for (const Scatter& scatter : world.scatter)
    count += scatter.count;
  return count;
}

void place_models(const World& world, const models::Registry& registry, core::BlockCoord block,
                  std::vector<Placement>& out) {
  // world.terrain has the edits.
  place_models(world, registry, block, {world.terrain, block, models_per_block(world)}, out);
}

void place_models(const World& world, const models::Registry& registry, core::BlockCoord block,
                  const models::BlockGround& ground, std::vector<Placement>& out) {
  place_wanted(world, registry, block, ground, nullptr, out);
}

void place_models(const World& world, const models::Registry& registry, core::BlockCoord block,
                  const std::vector<bool>& wanted, std::vector<Placement>& out) {
  PSYGEN_ASSERT(wanted.size() == world.scatter.size(), "wanted needs one entry for each scatter");
  std::size_t count = 0;
  for (std::size_t s = 0; s < world.scatter.size(); ++s)
    count += wanted[s] ? world.scatter[s].count : 0;
  const bool by_hand = (world.edits && world.edits->block(block) != nullptr) ||
                       (world.places.by_block && world.places.by_block->block(block) != nullptr);
  if (count == 0 && !by_hand) return out.clear();
  place_wanted(world, registry, block, {world.terrain, block, count}, &wanted, out);
}

float road_at(const World& world, core::BlockCoord block, glm::dvec2 local_m) {
  if (world.shaped.roads.empty() || !world.shaped.layer) return 0;
  const double block_m = world.block_size_m();
  double share = 0;
  for (const models::GroundEdit* edit :
       world.shaped.layer->ground.roads_in(models::QuadCoord::of(block), block_m))
    share = std::max(share, road_share(*edit->road, models::from_origin_m(edit->road->origin, block,
                                                                          local_m, block_m)));
  return static_cast<float>(share);
}

void set_parameter(const models::ModelType& type, models::Parameters& parameters, std::size_t i,
                   double value) {
  if (type.parameters()[i].type == models::ParameterType::kInteger) {
    // The upper limit is below 2^63, which a 64-bit integer cannot hold.
    parameters.set_integer(i, std::llround(std::clamp(value, -0x1.0p63, 0x1.fffffffffffffp62)));
  } else {
    parameters.set_real(i, value);
  }
}

SlopeParameters slope_parameters(const models::ModelType& type) {
  SlopeParameters indices{models::parameter_index(type, "slope_x"),
                          models::parameter_index(type, "slope_z")};
  for (int& i : indices) {
    const bool placed = i >= 0 && type.parameters()[static_cast<std::size_t>(i)].source ==
                                      models::ParameterSource::kPlaced;
    if (!placed) i = -1;
  }
  return indices;
}

void set_slope(const models::ModelType& type, const SlopeParameters& indices, glm::vec2 slope,
               models::Parameters& parameters) {
  for (int axis = 0; axis < 2; ++axis) {
    const int index = indices[static_cast<std::size_t>(axis)];
    if (index < 0) continue;
    const auto i = static_cast<std::size_t>(index);
    const models::ParameterSpec& spec = type.parameters()[i];
    set_parameter(type, parameters, i,
                  std::clamp(static_cast<double>(slope[axis]), spec.hard_min, spec.hard_max));
  }
}

models::Parameters scatter_parameters(const models::Registry& registry, const Scatter& scatter) {
  const models::ModelType& type = registry[scatter.model];
  models::Parameters p = models::default_parameters(type);
  for (std::size_t i = 0; i < scatter.ranges.size(); ++i) {
    if (type.parameters()[i].source == models::ParameterSource::kUser)
      set_parameter(type, p, i, scatter.ranges[i].low);
  }
  return p;
}

models::Parameters draw_parameters(const World& world, const models::Registry& registry,
                                   const Scatter& scatter, core::BlockCoord block,
                                   std::uint32_t index) {
  BlockObstacles obstacles(world, block);
  return Scattering(world, registry[scatter.model], scatter, obstacles).parameters(index);
}

glm::vec2 models_reach_m(const World& world, const models::Registry& registry) {
  // Maximum number of ranged parameters whose ends are tried in all combinations.
  constexpr std::size_t kMaxVaried = 12;
  glm::vec2 reach_m(0.0F);
  for (const Scatter& scatter : world.scatter) {
    const models::ModelType& type = registry[scatter.model];
    const auto specs = type.parameters();
    std::vector<std::size_t> ranged;
    for (std::size_t i = 0; i < specs.size(); ++i) {
      if (scatter.ranges[i].low != scatter.ranges[i].high) ranged.push_back(i);
    }
    const std::size_t varied = std::min(ranged.size(), kMaxVaried);
    for (std::uint32_t corner = 0; corner < (1u << varied); ++corner) {
      models::Parameters p = scatter_parameters(registry, scatter);
      for (std::size_t k = 0; k < varied; ++k) {
        const ParameterRange& range = scatter.ranges[ranged[k]];
        set_parameter(type, p, ranged[k], (corner >> k & 1) != 0 ? range.high : range.low);
      }
      const auto steepest =
          static_cast<float>(std::tan(scatter.max_slope_deg * std::numbers::pi / 180));
      set_slope(type, slope_parameters(type), glm::vec2(steepest), p);
      const core::Bounds box = type.bounds(p);
      reach_m.x = std::max({reach_m.x, -box.min.x, -box.min.z, box.max.x, box.max.z});
      reach_m.y = std::max(reach_m.y, box.max.y);
    }
  }
  return reach_m;
}

glm::vec2 with_placed_models(glm::vec2 scattered, const World& world) {
  for (const models::EditLayer* layer : {world.edits.get(), world.places.by_block.get()}) {
    if (layer == nullptr || layer->blocks.empty()) continue;
    const glm::vec3& placed = layer->blocks.root()->summary.reach_m;
    scattered = glm::max(scattered, glm::vec2(placed.x, placed.y));
  }
  return scattered;
}

}  // namespace psygen::world
