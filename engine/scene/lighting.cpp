#include "engine/scene/lighting.hpp"

#include <algorithm>

namespace psygen::scene {
namespace {

// Extinction over the view distance that hides where the world ends (contrast e^−2, 14 %).
constexpr double kOpaque = 2.0;

}  // namespace

render::Light light_of(const world::World& world, double view_distance_m) {
  const world::Sky& sky = world.sky;
  render::Light light;
  light.sun_direction = sky.sun_direction();
  light.sun_colour = sky.sun_colour;
  light.zenith_colour = sky.zenith_colour;
  light.horizon_colour = sky.horizon_colour;
  light.ground_colour = sky.ground_colour;
  light.haze_colour = sky.haze_colour;
  light.haze_density = static_cast<float>(std::max(sky.haze_density(), kOpaque / view_distance_m));
  light.haze_height_falloff = static_cast<float>(1.0 / sky.haze_height_m);
  light.exposure = static_cast<float>(sky.exposure);
  light.cloud_cover = static_cast<float>(sky.cloud_cover);
  return light;
}

render::TerrainPalette palette_of(const world::World& world) {
  const world::Palette& from = world.palette;
  const auto metres = [](double value) { return static_cast<float>(value); };
  render::TerrainPalette to;
  to.grass = from.grass;
  to.forest = from.forest;
  to.dry = from.dry;
  to.rock = from.rock;
  to.snow = from.snow;
  to.sand = from.sand;
  to.sand_end_m = metres(from.sand_end_m);
  to.sand_blend_m = metres(from.sand_blend_m);
  to.dry_start_m = metres(from.dry_start_m);
  to.dry_blend_m = metres(from.dry_blend_m);
  to.snow_start_m = metres(from.snow_start_m);
  to.snow_blend_m = metres(from.snow_blend_m);
  to.rock_slope_start = metres(from.rock_slope_start);
  to.rock_slope_full = metres(from.rock_slope_full);
  to.snow_slope_max = metres(from.snow_slope_max);
  return to;
}

}  // namespace psygen::scene
