#include "engine/world/water.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/core/rounding.hpp"
#include "engine/models/edits.hpp"
#include "engine/models/terrain/ground.hpp"

namespace psygen::world {
namespace {

std::uint64_t with_number(std::uint64_t hash, double value) {
  return core::combine(hash, std::bit_cast<std::uint64_t>(value));
}

std::uint64_t with_points(std::uint64_t hash, const std::vector<glm::dvec2>& points) {
  hash = core::combine(hash, points.size());
  for (const glm::dvec2& point : points)
    hash = with_number(with_number(hash, point.x), point.y);
  return hash;
}

// The surface over a place, of a layer's rivers and lakes and of the sea.
std::optional<WaterSurface> surface_over(const World& world, const models::EditLayer* layer,
                                         const core::WorldPosition& at) {
  const core::RoundToNearest rounding;
  if (layer == nullptr) return sea_surface(world);
  const double block_m = world.block_size_m();
  const core::WorldPosition place = core::normalised(at, block_m);
  const auto body = layer->ground.water_over(place.block, {place.local.x, place.local.z}, block_m);
  if (!body || (world.water.exists() && body->surface_m < world.water.level_m))
    return sea_surface(world);
  const double steep = std::sqrt(1 + body->slope.x * body->slope.x + body->slope.y * body->slope.y);
  return WaterSurface{
      .surface_m = body->surface_m,
      .normal = glm::vec3(-body->slope.x, 1, -body->slope.y) / static_cast<float>(steep),
      .flow_m_s = glm::vec2(body->flow_m_s),
      .foam = static_cast<float>(body->foam),
      .discharge_m3_s = body->discharge_m3_s,
      .body = body->body};
}

}  // namespace

bool has_water(const World& world) {
  return world.water.exists() || (world.layer() && world.layer()->ground.has_water());
}

std::optional<WaterSurface> water_surface(const World& world, const core::WorldPosition& at) {
  return surface_over(world, world.layer().get(), at);
}

std::optional<WaterSurface> function_water_surface(const World& world,
                                                   const core::WorldPosition& at) {
  return surface_over(world, world.shaped.layer.get(), at);
}

std::optional<WaterSurface> sea_surface(const World& world) {
  if (!world.water.exists()) return std::nullopt;
  WaterSurface sea;
  sea.surface_m = world.water.level_m;
  sea.body = kSea;
  return sea;
}

std::uint64_t bodies_hash_in(const World& world, core::BlockCoord block) {
  if (!world.shaped.layer) return 0;
  std::uint64_t hash = 0;
  auto pieces = world.shaped.layer->ground.shapes.water_in(models::QuadCoord::of(block),
                                                           world.block_size_m());
  std::ranges::sort(pieces, {}, &models::GroundEdit::order);
  for (const models::GroundEdit* piece : pieces)
    hash = core::combine(
        hash, piece->river ? models::content_of(*piece->river) : models::content_of(*piece->lake));
  return hash;
}

std::uint64_t bodies_hash(const std::vector<Lake>& lakes) {
  const auto count = std::ranges::count(lakes, true, &Lake::enabled);
  std::uint64_t hash = core::mix64(static_cast<std::uint64_t>(count));
  for (const Lake& lake : lakes) {
    if (!lake.enabled) continue;
    hash = with_points(hash, lake.points_m);
    for (const double v :
         {lake.centre_m.x, lake.centre_m.y, lake.radius_m, lake.spill_m.value_or(0),
          lake.spill_m ? 1.0 : 0.0, lake.depth_m, lake.shore_m})
      hash = with_number(hash, v);
  }
  return hash;
}

std::uint64_t bodies_hash(const std::vector<River>& rivers) {
  const auto count = std::ranges::count(rivers, true, &River::enabled);
  std::uint64_t hash = core::mix64(static_cast<std::uint64_t>(count));
  for (const River& river : rivers) {
    if (!river.enabled) continue;
    hash = with_points(hash, river.points_m);
    for (const auto* list : {&river.width_m, &river.depth_m, &river.discharge_m3_s}) {
      hash = core::combine(hash, list->size());
      for (const double number : *list)
        hash = with_number(hash, number);
    }
    hash = with_number(with_number(hash, river.bank_m), river.smoothing_m);
  }
  return hash;
}

WaterPoint water_at(const World& world, const core::WorldPosition& at, double ground_m) {
  const auto water = water_surface(world, at);
  const double depth_m = water ? water->depth_over(ground_m) : 0;
  return depth_m > 0 ? WaterPoint{*water, depth_m} : WaterPoint();
}

WaterPoint water_at(const World& world, const core::WorldPosition& at) {
  return water_at(world, at,
                  models::ground_height_m(world.terrain, at.block, at.local.x, at.local.z));
}

}  // namespace psygen::world
