// The fields of sky, water, palette and places of models in one list, for reading, for writing and
// for editors. Each visitor calls visit(name, field, FieldSpec) for every field, in the order of
// the file. It reads no text (table_reader.hpp). Internal to world.
#pragma once

#include "engine/models/number_spec.hpp"
#include "engine/world/files/table_reader.hpp"
#include "engine/world/files/toml_values.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

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
        Spec{-360, 360, 0, 360, "degrees", "where the sun stands, from north towards east"});
  visit("sun_elevation_deg", sky.sun_elevation_deg,
        Spec{-90, 90, -10, 90, "degrees", "how high the sun stands above the horizon"});
  visit("sun_colour", sky.sun_colour, radiance(8, "light of the sun, linear radiance"));
  visit("zenith_colour", sky.zenith_colour, radiance(2, "of the sky overhead, linear radiance"));
  visit("horizon_colour", sky.horizon_colour,
        radiance(2, "of the sky at the horizon, linear radiance"));
  visit("ground_colour", sky.ground_colour, radiance(1, "light from below, linear radiance"));
  visit("haze_colour", sky.haze_colour, radiance(2, "of the haze far away, linear radiance"));
  visit("visibility_m", sky.visibility_m,
        Spec{10, 1e7, 500, 1e5, "m", "distance at which 2 % of the contrast is left, at height 0"});
  visit("haze_height_m", sky.haze_height_m,
        Spec{1, 1e7, 50, 5000, "m", "the haze thins by a factor of e over this height"});
  visit("exposure", sky.exposure,
        Spec{0.01, 100, 0.1, 10, "", "brightness of the picture: twice as much is one stop"});
  visit("cloud_cover", sky.cloud_cover, Spec{0, 1, 0, 1, "", "0 clear, 1 overcast"});
  visit("day_length_s", sky.day_length_s,
        Spec{0, 1e7, 0, 3600, "s", "length of 24 hours; 0: the sun stands still"});
  visit("start_hour", sky.start_hour,
        Spec{0, 24, 0, 24, "h", "hour of the day at the start; the sun is highest at 12"});
  visit("latitude_deg", sky.latitude_deg,
        Spec{-80, 80, -80, 80, "degrees", "decides how high the sun climbs"});
}

// The fields of Water.
template <class W, class Visit>
void visit_water(W& water, const Visit& visit) {
  visit("level_m", water.level_m,
        FieldSpec{-1e7, 1e7, 0, 500, "m", "height of the surface; -1000000 and below: no water"});
  visit("colour", water.colour, albedo("of deep water, linear albedo"));
  visit("shore_m", water.shore_m,
        FieldSpec{0, 1000, 0, 20, "m", "how far above the surface sand reaches"});
}

// The fields of Palette.
template <class P, class Visit>
void visit_palette(P& palette, const Visit& visit) {
  visit("grass", palette.grass, albedo("of meadows, linear albedo"));
  visit("forest", palette.forest, albedo("of the ground under trees, linear albedo"));
  visit("dry", palette.dry, albedo("of dry meadows, linear albedo"));
  visit("rock", palette.rock, albedo("of bare rock, linear albedo"));
  visit("snow", palette.snow, albedo("of snow, linear albedo"));
  visit("sand", palette.sand, albedo("of sand, linear albedo"));
  visit("sand_end_m", palette.sand_end_m, ground_height("sand below this height"));
  visit("sand_blend_m", palette.sand_blend_m, blend("over which sand ends"));
  visit("dry_start_m", palette.dry_start_m, ground_height("dry meadow above this height"));
  visit("dry_blend_m", palette.dry_blend_m, blend("over which dry meadow begins"));
  visit("snow_start_m", palette.snow_start_m,
        ground_height("snow above this height, where it is not too steep"));
  visit("snow_blend_m", palette.snow_blend_m, blend("over which snow begins"));
  visit("rock_slope_start", palette.rock_slope_start,
        slope("where bare rock begins: 0 flat, 0.29 at 45 degrees, 1 vertical"));
  visit("rock_slope_full", palette.rock_slope_full,
        slope("where bare rock covers everything: 0 flat, 0.29 at 45 degrees, 1 vertical"));
  visit("snow_slope_max", palette.snow_slope_max,
        slope("steeper ground sheds its snow: 0 flat, 0.29 at 45 degrees, 1 vertical"));
}

// The numbers of a HandmadeModel.
template <class M, class Visit>
void visit_handmade(M& model, const Visit& visit) {
  visit("size_m", model.size_m,
        FieldSpec{0, 1000, 0, 50, "m", "height; 0: that of the file, times scale"});
  visit("scale", model.scale,
        FieldSpec{1e-6, 1e6, 0.01, 100, "", "metres of the world for one of the file"});
  visit("sink_m", model.sink_m,
        FieldSpec{0, 100, 0, 5, "m", "how deep its lowest point is in the ground"});
  visit("levels", model.levels, FieldSpec{1, 8, 1, 8, "", "levels of detail, at most"});
}

// The fields of a [[scatter]] that say where instances may stand.
template <class S, class Visit>
void visit_place(S& scatter, const Visit& visit) {
  visit("min_height_m", scatter.min_height_m,
        FieldSpec{-1e7, 1e7, 0, 500, "m", "lowest ground on which instances stand"});
  visit("max_height_m", scatter.max_height_m,
        FieldSpec{-1e7, 1e7, 0, 500, "m", "highest ground on which instances stand"});
  visit("max_slope_deg", scatter.max_slope_deg,
        FieldSpec{0, 90, 0, 90, "degrees", "steepest ground on which instances stand"});
}

// The numbers of a ScatterMask.
template <class M, class Visit>
void visit_mask(M& mask, const Visit& visit) {
  visit("mask_noise_m", mask.noise_m,
        FieldSpec{0, 1e6, 0, 1000, "m", "size of patches in which instances stand; 0: everywhere"});
  visit("mask_share", mask.share,
        FieldSpec{0, 1, 0, 1, "", "share of the ground that the patches cover"});
  visit(
      "mask_patches", mask.patches,
      FieldSpec{0, 1e6, 0, 20, "", "which patches: those of equal numbers and sizes are the same"});
}

// The numbers of a Place, beside the parameters of its model.
template <class P, class Visit>
void visit_placed(P& place, const Visit& visit) {
  visit("above_m", place.above_m,
        FieldSpec{-1000, 1000, -10, 100, "m", "how high its foot is over the ground"});
}

// The numbers of a Stamp.
template <class S, class Visit>
void visit_stamp(S& stamp, const Visit& visit) {
  visit("size_m", stamp.size_m, FieldSpec{1, 20'000, 10, 2000, "m", "side of the square"});
  visit("turn_deg", stamp.turn_deg,
        FieldSpec{-360, 360, 0, 360, "degrees", "how far it is turned about the vertical axis"});
  visit("base_m", stamp.base_m, FieldSpec{-1e5, 1e5, 0, 100, "m", "height of black"});
  visit("height_m", stamp.height_m,
        FieldSpec{-1e5, 1e5, 0, 100, "m", "height of white above that of black"});
  visit("border_m", stamp.border_m,
        FieldSpec{0, 20'000, 0, 200, "m", "inside the square, over which the stamp fades out"});
}

// The numbers of a Road.
template <class R, class Visit>
void visit_road(R& road, const Visit& visit) {
  visit("width_m", road.width_m, FieldSpec{0.5, 200, 2, 30, "m", "of what is flat"});
  visit("border_m", road.border_m,
        FieldSpec{0, 500, 0, 50, "m", "on both sides, over which the road meets the ground"});
  visit("smoothing_m", road.smoothing_m,
        FieldSpec{0, 1000, 0, 200, "m", "how calmly the road follows the ground"});
  visit("clear_m", road.clear_m, FieldSpec{0, 100, 0, 10, "m", "on both sides, without models"});
}

// The numbers of a world that are not of its terrain.
inline constexpr FieldSpec kBlocks{
    0, 0x1.0p31, 0, 1024, "blocks", "number of blocks along x and z; 0: without an end"};
inline constexpr FieldSpec kCount{0, kMaxModelsPerBlock, 0, 200, "", "instances on each block"};

// Parameters of the terrain that the table [world] has under these keys, instead of [terrain].
struct TerrainAlias {
  std::string_view key, parameter;
};
inline constexpr TerrainAlias kWorldKeys[] = {{"cell_m", "cell_m"}, {"block_vertices", "size"}};

}  // namespace psygen::world
