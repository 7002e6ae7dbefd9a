#include "engine/world/water.hpp"

#include "engine/models/terrain/ground.hpp"

namespace psygen::world {

std::optional<WaterSurface> water_surface(const World& world, const core::WorldPosition& at) {
  static_cast<void>(at);  // the sea is everywhere
  if (!world.water.exists()) return std::nullopt;
  WaterSurface sea;
  sea.surface_m = world.water.level_m;
  sea.body = kSea;
  return sea;
}

WaterPoint water_at(const World& world, const core::WorldPosition& at, double ground_m) {
  const auto water = water_surface(world, at);
  const double depth_m = water ? water->depth_m(ground_m) : 0;
  if (depth_m <= 0) return {};
  return {.surface_m = water->surface_m,
          .depth_m = depth_m,
          .normal = water->normal,
          .flow_m_s = water->flow_m_s,
          .foam = water->foam,
          .body = water->body};
}

WaterPoint water_at(const World& world, const core::WorldPosition& at) {
  return water_at(world, at,
                  models::ground_height_m(world.terrain, at.block, at.local.x, at.local.z));
}

}  // namespace psygen::world
