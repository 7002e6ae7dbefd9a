// The fields of sky, water, palette and placed models in one list, for reading, for writing and for
// editors. Each visitor calls visit(name, field, FieldSpec) for every field, in the order of the
// file. It reads no text (table_reader.hpp). Internal to world.
#pragma once

#include "engine/models/model_type.hpp"
#include "engine/world/files/table_reader.hpp"
#include "engine/world/files/toml_values.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// Limits, unit and description of a field.
using FieldSpec = models::NumberSpec;

// A visitor that writes every field as TOML.
struct FieldWriter {
  std::string& text;
  void operator()(std::string_view key, double value, const FieldSpec&) const {
    text.append(key).append(" = ").append(toml_number(value)).append("\n");
  }
  void operator()(std::string_view key, std::int64_t value, const FieldSpec&) const {
    text.append(key).append(" = ").append(toml_number(value)).append("\n");
  }
  void operator()(std::string_view key, const glm::vec3& value, const FieldSpec&) const {
    text.append(key).append(" = ").append(toml_vector(value)).append("\n");
  }
};

// The limits of common quantities; `usual` is the end of a slider.
constexpr FieldSpec radiance(double usual, std::string_view doc) {
  return {0, 1000, 0, usual, "", doc};
}
constexpr FieldSpec albedo(std::string_view doc) {
  return {0, 1, 0, 1, "", doc};
}
constexpr FieldSpec ground_height(std::string_view doc) {
  return {-1e7, 1e7, 0, 500, "m", doc};
}
constexpr FieldSpec blend(std::string_view doc) {
  return {0.01, 1e6, 0.5, 100, "m", doc};
}
constexpr FieldSpec slope(std::string_view doc) {
  return {0, 1, 0, 1, "", doc};
}

// The fields of Sky.
template <class S, class Visit>
void visit_sky(S& sky, const Visit& visit) {
  using Spec = FieldSpec;
  visit("sun_azimuth_deg", sky.sun_azimuth_deg,
        Spec{-360, 360, 0, 360, "degrees", "direction of the sun, from north towards east"});
  visit("sun_elevation_deg", sky.sun_elevation_deg,
        Spec{-90, 90, -10, 90, "degrees", "height of the sun above the horizon"});
  visit("sun_colour", sky.sun_colour, radiance(8, "sunlight, linear radiance"));
  visit("zenith_colour", sky.zenith_colour, radiance(2, "sky overhead, linear radiance"));
  visit("horizon_colour", sky.horizon_colour, radiance(2, "sky at the horizon, linear radiance"));
  visit("ground_colour", sky.ground_colour, radiance(1, "light from below, linear radiance"));
  visit("haze_colour", sky.haze_colour, radiance(2, "distant haze, linear radiance"));
  visit("visibility_m", sky.visibility_m,
        Spec{10, 1e7, 500, 1e5, "m", "distance at which 2 % of the contrast remains, at height 0"});
  visit("haze_height_m", sky.haze_height_m,
        Spec{1, 1e7, 50, 5000, "m", "the haze thins by a factor of e over this height"});
  visit("exposure", sky.exposure,
        Spec{0.01, 100, 0.1, 10, "", "brightness of the image; doubling it is one stop"});
  visit("cloud_cover", sky.cloud_cover, Spec{0, 1, 0, 1, "", "0 clear, 1 overcast"});
  visit("day_length_s", sky.day_length_s,
        Spec{0, 1e7, 0, 3600, "s", "duration of 24 hours; 0: the sun does not move"});
  visit("start_hour", sky.start_hour,
        Spec{0, 24, 0, 24, "h", "hour of the day at the start; the sun is highest at 12"});
  visit("latitude_deg", sky.latitude_deg,
        Spec{-80, 80, -80, 80, "degrees", "affects the sun's highest elevation"});
}

// The fields of Water.
template <class W, class Visit>
void visit_water(W& water, const Visit& visit) {
  visit("level_m", water.level_m,
        FieldSpec{-1e7, 1e7, 0, 500, "m", "water level; no water at -1000000 or below"});
  visit("colour", water.colour, albedo("deep water, linear albedo"));
  visit("shore_m", water.shore_m,
        FieldSpec{0, 1000, 0, 20, "m", "height of the sand above the water level"});
}

// The fields of Palette.
template <class P, class Visit>
void visit_palette(P& palette, const Visit& visit) {
  visit("grass", palette.grass, albedo("meadows, linear albedo"));
  visit("forest", palette.forest, albedo("ground under trees, linear albedo"));
  visit("dry", palette.dry, albedo("dry meadows, linear albedo"));
  visit("rock", palette.rock, albedo("bare rock, linear albedo"));
  visit("snow", palette.snow, albedo("snow, linear albedo"));
  visit("sand", palette.sand, albedo("sand, linear albedo"));
  visit("sand_end_m", palette.sand_end_m, ground_height("sand below this height"));
  visit("sand_blend_m", palette.sand_blend_m, blend("height range over which sand ends"));
  visit("dry_start_m", palette.dry_start_m, ground_height("dry meadow above this height"));
  visit("dry_blend_m", palette.dry_blend_m, blend("height range over which dry meadow begins"));
  visit("snow_start_m", palette.snow_start_m,
        ground_height("snow above this height, except on steep ground"));
  visit("snow_blend_m", palette.snow_blend_m, blend("height range over which snow begins"));
  visit("rock_slope_start", palette.rock_slope_start,
        slope("slope at which bare rock begins: 0 flat, 0.29 at 45 degrees, 1 vertical"));
  visit(
      "rock_slope_full", palette.rock_slope_full,
      slope("slope at which bare rock covers everything: 0 flat, 0.29 at 45 degrees, 1 vertical"));
  visit("snow_slope_max", palette.snow_slope_max,
        slope("steeper ground has no snow: 0 flat, 0.29 at 45 degrees, 1 vertical"));
}

// The numbers of a HandmadeModel.
template <class M, class Visit>
void visit_handmade(M& model, const Visit& visit) {
  visit("size_m", model.size_m,
        FieldSpec{0, 1000, 0, 50, "m", "height; 0: height in the file times scale"});
  visit("scale", model.scale,
        FieldSpec{1e-6, 1e6, 0.01, 100, "", "size in the world over size in the file"});
  visit("sink_m", model.sink_m,
        FieldSpec{0, 100, 0, 5, "m", "depth of its lowest point in the ground"});
  visit("levels", model.levels, FieldSpec{1, 8, 1, 8, "", "maximum number of levels of detail"});
}

// The fields of a [[scatter]] that limit the positions of instances.
template <class S, class Visit>
void visit_place(S& scatter, const Visit& visit) {
  visit("min_height_m", scatter.min_height_m,
        FieldSpec{-1e7, 1e7, 0, 500, "m", "lowest ground with instances"});
  visit("max_height_m", scatter.max_height_m,
        FieldSpec{-1e7, 1e7, 0, 500, "m", "highest ground with instances"});
  visit("max_slope_deg", scatter.max_slope_deg,
        FieldSpec{0, 90, 0, 90, "degrees", "steepest ground with instances"});
}

// The numbers of a ScatterMask.
template <class M, class Visit>
void visit_mask(M& mask, const Visit& visit) {
  visit("mask_noise_m", mask.noise_m,
        FieldSpec{0, 1e6, 0, 1000, "m", "size of the patches with instances; 0: no patches"});
  visit("mask_share", mask.share,
        FieldSpec{0, 1, 0, 1, "", "fraction of the ground that the patches cover"});
  visit("mask_patches", mask.patches,
        FieldSpec{0, 1e6, 0, 20, "",
                  "random seed of the patches; equal seeds and sizes give equal patches"});
}

// The numbers of a Place, without the parameters of its model.
template <class P, class Visit>
void visit_placed(P& place, const Visit& visit) {
  visit("above_m", place.above_m,
        FieldSpec{-1000, 1000, -10, 100, "m", "height of its base point above the ground"});
}

// The numbers of a Stamp.
template <class S, class Visit>
void visit_stamp(S& stamp, const Visit& visit) {
  visit("size_m", stamp.size_m, FieldSpec{1, 20'000, 10, 2000, "m", "side length of the square"});
  visit("turn_deg", stamp.turn_deg,
        FieldSpec{-360, 360, 0, 360, "degrees", "rotation about the vertical axis"});
  visit("base_m", stamp.base_m, FieldSpec{-1e5, 1e5, 0, 100, "m", "height of black pixels"});
  visit("height_m", stamp.height_m,
        FieldSpec{-1e5, 1e5, 0, 100, "m", "height of white pixels above black ones"});
  visit("border_m", stamp.border_m,
        FieldSpec{0, 20'000, 0, 200, "m", "width of the fade inside the square"});
}

// The numbers of a Road.
template <class R, class Visit>
void visit_road(R& road, const Visit& visit) {
  visit("width_m", road.width_m, FieldSpec{0.5, 200, 2, 30, "m", "width of the flat part"});
  visit("border_m", road.border_m,
        FieldSpec{0, 500, 0, 50, "m", "on both sides: width of the transition to the ground"});
  visit("smoothing_m", road.smoothing_m,
        FieldSpec{0, 1000, 0, 200, "m", "heights are averaged over this distance"});
  visit("clear_m", road.clear_m,
        FieldSpec{0, 100, 0, 10, "m", "on both sides: strip without models"});
}

// The numbers of a world outside of its terrain.
inline constexpr FieldSpec kBlocks{0,    0x1.0p31, 0,
                                   1024, "blocks", "number of blocks along x and z; 0: endless"};
inline constexpr FieldSpec kCount{0, kMaxModelsPerBlock, 0, 200, "", "instances on each block"};

// Parameters of the terrain that have these keys in the table [world], instead of [terrain].
struct TerrainAlias {
  std::string_view key, parameter;
};
inline constexpr TerrainAlias kWorldKeys[] = {{"cell_m", "cell_m"}, {"block_vertices", "size"}};

}  // namespace psygen::world
