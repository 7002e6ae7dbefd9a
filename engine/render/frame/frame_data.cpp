#include "engine/render/frame/frame_data.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace psygen::render {

namespace {

// The slow pattern of the ground repeats after 64 lattice points of 32 m (ground.glsl).
constexpr double kPatternPeriod = 2048.0;

float pattern_coordinate(std::int32_t block, double block_size_m, double local) {
  const double metres = std::fmod(static_cast<double>(block) * block_size_m, kPatternPeriod);
  const double inside = std::fmod(metres + local, kPatternPeriod);
  return static_cast<float>(inside < 0 ? inside + kPatternPeriod : inside);
}

void set_camera(shaders::FrameData& out, const FrameInput& input, core::Extent size) {
  const glm::mat4 rotation = core::view_rotation(input.pose);
  out.clip_from_camera = core::projection_matrix(input.projection) * rotation;
  const auto row = [&](int i) { return glm::vec3(rotation[0][i], rotation[1][i], rotation[2][i]); };
  const float tangent = std::tan(input.projection.vertical_fov * 0.5F);
  out.ray_right = {row(0) * tangent * input.projection.aspect, 0.0F};
  out.ray_down = {-row(1) * tangent, 0.0F};
  out.ray_forward = {-row(2), 0.0F};
  const core::WorldPosition& at = input.pose.position;
  const bool anchored = input.block_size_m > 0;
  out.ground_anchor = {
      anchored ? pattern_coordinate(at.block.x, input.block_size_m, at.local.x) : 0.0F,
      anchored ? pattern_coordinate(at.block.z, input.block_size_m, at.local.z) : 0.0F,
      static_cast<float>(size.width), static_cast<float>(size.height)};
}

// Clouds: repeats of their texture for each metre, which puts their base 1100 m high (clouds.glsl
// has 0.27 for a height of 1), and how far the wind moves them.
constexpr double kCloudRepeats = 0.27 / 1100.0;
constexpr double kCloudDriftX = 0.002, kCloudDriftZ = 0.0006;  // repeats per second

void set_clouds(shaders::FrameData& out, const FrameInput& input) {
  const core::WorldPosition& at = input.pose.position;
  const double seconds = input.light.time_seconds;
  // Repeats of a block in 2^-32, so that they meet where the numbers of blocks wrap.
  const auto of_block =
      static_cast<std::uint32_t>(std::llround(input.block_size_m * kCloudRepeats * 0x1p32));
  const auto place = [&](std::int32_t block, double local, double drift) {
    const double corner = static_cast<std::uint32_t>(block) * of_block * 0x1p-32;
    const double repeats = corner + local * kCloudRepeats + seconds * drift;
    return static_cast<float>(repeats - std::floor(repeats));
  };
  out.clouds = {place(at.block.x, at.local.x, kCloudDriftX),
                place(at.block.z, at.local.z, kCloudDriftZ), static_cast<float>(kCloudRepeats),
                0.0F};
}

void set_light(shaders::FrameData& out, const FrameInput& input) {
  const Light& light = input.light;
  const float e = light.exposure;
  const float altitude = static_cast<float>(input.pose.position.local.y);
  const float exponent = std::clamp(light.haze_height_falloff * altitude, -20.0F, 20.0F);
  const float length = glm::length(light.sun_direction);
  const glm::vec3 sun = length > 0 ? light.sun_direction / length : glm::vec3(0, 1, 0);
  out.sun_direction = {sun, light.time_seconds};
  out.sun_colour = {light.sun_colour * e, e};
  out.glow_colour = {light.glow_colour * e, 0.0F};
  out.glow_direction = {glm::normalize(glm::vec3(sun.x, std::max(sun.y, 0.01F), sun.z)), 0.0F};
  out.cloud_colour = {light.cloud_colour * e, 0.0F};
  out.haze_extinction = {light.haze_tint * (light.haze_density * std::exp(-exponent)), 0.0F};
  out.zenith_colour = {light.zenith_colour * e, light.haze_height_falloff};
  out.horizon_colour = {light.horizon_colour * e, altitude};
  out.ground_colour = {light.ground_colour * e, input.block_size_m > 0 ? 1.0F : 0.0F};
  out.haze_colour = {light.haze_colour * e, light.cloud_cover};
}

// Without water, its level is at a height that no ground reaches.
constexpr float kNoWaterM = -1e9F;
// Extinction of red, green and blue under water, in 1/m.
constexpr glm::vec3 kWaterExtinction{0.30F, 0.10F, 0.07F};
// Seen from above, water near shores is more turbid. Metres that light goes through it to the
// ground and back, for each metre of its depth, and extinction to the loss of under_water.glsl.
constexpr float kTurbidity = 0.09F, kWaysThroughWater = 2.6F, kLossOfExtinction = 0.5F;

// Replaces the air by water, for a camera under water.
void dive(shaders::FrameData& out) {
  const glm::vec3 above = glm::vec3(out.horizon_colour) + glm::vec3(out.zenith_colour) +
                          std::max(out.sun_direction.y, 0.0F) * glm::vec3(out.sun_colour);
  const glm::vec3 light = 2.0F * glm::vec3(out.water) * above;
  for (glm::vec4* colour : {&out.zenith_colour, &out.horizon_colour, &out.haze_colour})
    *colour = {light, colour->w};
  out.glow_colour = out.cloud_colour = glm::vec4(0.0F);
  out.haze_extinction = {kWaterExtinction, 0.0F};
  out.zenith_colour.w = 0.0F;  // equally dense at every depth
  out.haze_colour.w = 0.0F;    // no clouds
}

void set_water_and_far_things(shaders::FrameData& out, const FrameInput& input) {
  const float altitude = static_cast<float>(input.pose.position.local.y);
  const WaterPlane water = input.water.value_or(WaterPlane{kNoWaterM, input.water_colour});
  out.water = {water.colour, water.level_m - altitude};
  const float sun = std::max(out.sun_direction.y, 0.0F);
  const glm::vec3 sky = glm::mix(glm::vec3(out.horizon_colour), glm::vec3(out.zenith_colour), 0.6F);
  out.deep_water = {water.colour * (sky + sun * glm::vec3(out.sun_colour)), 0.0F};
  if (out.water.w <= 0)
    out.water_loss = {(kWaterExtinction + kTurbidity) * (kWaysThroughWater * kLossOfExtinction),
                      0.0F};
  if (out.water.w > 0) dive(out);
  const Canopy& canopy = input.canopy;
  out.canopy = {canopy.colour, canopy.slope_max};
  out.canopy_place = {canopy.lowest_m, canopy.highest_m, 1.0F / std::max(canopy.blend_m, 1e-3F),
                      0.0F};
  out.morph = {input.morph.from_m, 1.0F / std::max(input.morph.to_m - input.morph.from_m, 1e-3F),
               input.fade_phase, 0.0F};
  out.edge = {input.edge.least, input.edge.greatest};
}

void set_palette(shaders::FrameData& out, const TerrainPalette& palette) {
  const auto blend = [](float metres) { return std::max(metres, 1e-3F); };
  out.grass = {palette.grass, palette.sand_end_m};
  out.forest = {palette.forest, palette.dry_start_m};
  out.dry = {palette.dry, blend(palette.dry_blend_m)};
  out.rock = {palette.rock, palette.rock_slope_start};
  out.snow = {palette.snow, std::max(palette.rock_slope_full, palette.rock_slope_start + 1e-3F)};
  out.sand = {palette.sand, blend(palette.sand_blend_m)};
  out.snow_line = {palette.snow_start_m, blend(palette.snow_blend_m), blend(palette.snow_slope_max),
                   0.0F};
}

void set_lamps(shaders::FrameData& out, const FrameInput& input) {
  static_assert(kMaxPointLights == PSYGEN_MAX_LAMPS);
  const std::size_t count = std::min(input.point_lights.size(), kMaxPointLights);
  out.lamp_count = {static_cast<float>(count), 0.0F, 0.0F, 0.0F};
  for (std::size_t i = 0; i < count; ++i) {
    const PointLight& light = input.point_lights[i];
    out.lamps[2 * i] = {light.position, 1.0F / std::max(light.range_m * light.range_m, 1e-6F)};
    out.lamps[2 * i + 1] = {light.light * input.light.exposure, 0.0F};
  }
}

// Largest distance outside a cascade, towards and away from the sun, of meshes that cast shadows
// into it.
constexpr float kCasterReachM = 1500;
constexpr float kMinElevation = 0.02F;  // of the sun, as a sine

// The camera's position along `axis` modulo `step` metres.
float within_step(const FrameInput& input, glm::dvec3 axis, double step) {
  const core::WorldPosition& at = input.pose.position;
  const glm::dvec3 world{at.block.x * input.block_size_m + at.local.x, at.local.y,
                         at.block.z * input.block_size_m + at.local.z};
  return static_cast<float>(std::fmod(glm::dot(world, axis), step));
}

}  // namespace

shaders::FrameData frame_data(const FrameInput& input, core::Extent size,
                              const PresetTraits& traits) {
  shaders::FrameData out{};
  set_camera(out, input, size);
  set_light(out, input);
  set_clouds(out, input);
  set_palette(out, input.palette);
  set_water_and_far_things(out, input);
  set_shadows(input, traits, out);
  set_lamps(out, input);
  return out;
}

void set_shadows(const FrameInput& input, const PresetTraits& traits, shaders::FrameData& out) {
  const glm::vec3 sun(out.sun_direction);
  const bool lit = sun.y > kMinElevation;
  out.shadow = {1.0F / static_cast<float>(traits.shadow_size),
                lit ? static_cast<float>(traits.cascades) : 0.0F, 0.0F, 0.0F};
  out.shadow_reach = {traits.reach_m[0], traits.reach_m[1], traits.reach_m[2], 0.0F};
  const glm::vec3 across = glm::normalize(
      std::abs(sun.y) < 0.99F ? glm::cross(sun, glm::vec3(0, 1, 0)) : glm::vec3(1, 0, 0));
  const glm::vec3 along = glm::cross(across, sun);
  for (std::uint32_t i = 0; i < traits.cascades; ++i) {
    const float reach = traits.reach_m[i], depth = reach + kCasterReachM;
    const double texel = 2.0 * reach / traits.shadow_size;
    glm::mat4& m = out.shadow_from_camera[i];
    m = glm::mat4(0.0F);
    for (int c = 0; c < 3; ++c) {
      m[c][0] = across[c] / reach;
      m[c][1] = along[c] / reach;
      m[c][2] = -sun[c] / (2.0F * depth);
    }
    m[3] = {within_step(input, across, texel) / reach, within_step(input, along, texel) / reach,
            0.5F, 1.0F};
  }
}

}  // namespace psygen::render
