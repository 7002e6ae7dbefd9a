#include "engine/scene/facts/lighting.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <limits>

#include "engine/world/atmosphere.hpp"

namespace psygen::scene {
namespace {

// Extinction over the view distance that hides the end of the world (contrast e^−1.5, 22 %).
constexpr double kOpaque = 1.5;
constexpr float kGlow = 1.0F / 0.13F;  // the shader's glow is 0.13 of the colour at its brightest
constexpr float kMaxCloud = 32.0F;     // maximum brightness relative to the file's sun

}  // namespace

render::Light light_of(const world::World& world, double view_distance_m, double time_s) {
  const world::Sky sky = world::sky_at(world.sky, time_s);
  const world::Daylight now = world::daylight(sky.sun_elevation_deg);
  render::Light light;
  light.sun_direction = sky.sun_direction();
  light.glow_colour = sky.haze_colour * kGlow * now.glow / now.haze;
  const glm::vec3 then = world::daylight(world.sky.sun_elevation_deg).cloud;
  light.cloud_colour = world.sky.sun_colour * glm::min(now.cloud / (then + 1e-4F), kMaxCloud);
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

void move_sun(const world::World& world, double time_s, render::Light& light) {
  const float haze_density = light.haze_density;
  light = light_of(world, std::numeric_limits<double>::infinity(), time_s);
  light.haze_density = haze_density;
}

std::optional<render::WaterPlane> water_of(const world::World& world) {
  if (!world.water.exists()) return std::nullopt;
  return render::WaterPlane{static_cast<float>(world.water.level_m), world.water.colour};
}

render::TerrainPalette palette_of(const world::World& world) {
  const world::Palette from = world::drawn_palette(world);
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

render::Canopy canopy_of(const world::World& world, const glm::vec3& albedo) {
  constexpr double kAnywhere = 1e6;
  double lowest = kAnywhere, highest = -kAnywhere, slope_deg = 0;
  for (const world::Scatter& scatter : world.scatter) {
    if (scatter.count == 0) continue;
    lowest = std::min(lowest, std::max(scatter.min_height_m, -kAnywhere));
    highest = std::max(highest, std::min(scatter.max_height_m, kAnywhere));
    slope_deg = std::max(slope_deg, scatter.max_slope_deg);
  }
  render::Canopy canopy;
  canopy.colour = albedo;
  canopy.lowest_m = static_cast<float>(lowest);
  canopy.highest_m = static_cast<float>(highest);
  canopy.slope_max = static_cast<float>(1 - std::cos(glm::radians(slope_deg)));
  return canopy;
}

render::WorldEdge edge_of(const world::World& world, const core::WorldPosition& camera) {
  render::WorldEdge edge;
  const glm::dvec3 first = core::offset_m({}, camera, world.block_size_m());
  const auto bound = [&](std::int64_t blocks, double least, int axis) {
    if (blocks == 0) return;
    edge.least[axis] = static_cast<float>(least);
    edge.greatest[axis] =
        static_cast<float>(least + static_cast<double>(blocks) * world.block_size_m());
  };
  bound(world.blocks_x, first.x, 0);
  bound(world.blocks_z, first.z, 1);
  return edge;
}

}  // namespace psygen::scene
