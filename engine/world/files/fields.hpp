// The fields of sky, water, palette and placed models in one list, for reading, for writing and for
// editors. Each visit_…(values, visit) calls visit(name, field, FieldSpec) for every field, in the
// order of the file. It reads no text (table_reader.hpp). Internal to world.
#pragma once

#include <algorithm>
#include <iterator>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/models/model_type.hpp"
#include "engine/world/files/table_reader.hpp"
#include "engine/world/files/toml_values.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// Limits, unit and description of a field.
using FieldSpec = models::NumberSpec;

// A visitor that reads every field that the table has.
struct FieldReader {
  TableReader& reader;
  void operator()(std::string_view key, auto& field, const FieldSpec& spec) const {
    reader.read(key, field, {spec.hard.min, spec.hard.max});
  }
};

// A visitor that writes every field as TOML.
struct FieldWriter {
  std::string& text;
  void operator()(std::string_view key, const auto& value, const FieldSpec&) const {
    text.append(key).append(" = ");
    if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>)
      text.append(toml_number(value)).append("\n");
    else
      text.append(toml_vector(value)).append("\n");
  }
};

// Writes the fields that differ from those of `usual`.
template <class T, class VisitFields>
void write_changed(const T& now, const T& usual, const VisitFields& visit_fields,
                   std::string& text) {
  const auto lines_of = [&](const T& of) {
    std::vector<std::string> lines;
    visit_fields(of, [&](std::string_view key, const auto& value, const FieldSpec& spec) {
      FieldWriter{lines.emplace_back()}(key, value, spec);
    });
    return lines;
  };
  const std::vector<std::string> lines = lines_of(now), defaults = lines_of(usual);
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i] != defaults[i]) text += lines[i];
}

// A field with these limits, and with a slider over the range `usual`.
constexpr FieldSpec in(std::string_view unit, Limits limits, Limits usual, std::string_view doc) {
  return {{limits.low, limits.high}, {usual.low, usual.high}, unit, doc};
}
// The limits of common quantities.
constexpr FieldSpec radiance(double usual, std::string_view doc) {
  return in("", {0, 1000}, {0, usual}, doc);
}
constexpr FieldSpec fraction(std::string_view doc) {
  return in("", {0, 1}, {0, 1}, doc);
}
constexpr FieldSpec ground_height(std::string_view doc) {
  return in("m", {-1e7, 1e7}, {0, 500}, doc);
}
constexpr FieldSpec blend(std::string_view doc) {
  return in("m", {0.01, 1e6}, {0.5, 100}, doc);
}
constexpr FieldSpec full_turn(std::string_view doc) {
  return in("degrees", {-360, 360}, {0, 360}, doc);
}

// The fields of Sky.
inline constexpr auto visit_sky = [](auto& sky, const auto& visit) {
  visit("sun_azimuth_deg", sky.sun_azimuth_deg,
        full_turn("direction of the sun, from north towards east"));
  visit("sun_elevation_deg", sky.sun_elevation_deg,
        in("degrees", {-90, 90}, {-10, 90}, "height of the sun above the horizon"));
  visit("sun_colour", sky.sun_colour, radiance(8, "sunlight, linear radiance"));
  visit("zenith_colour", sky.zenith_colour, radiance(2, "sky overhead, linear radiance"));
  visit("horizon_colour", sky.horizon_colour, radiance(2, "sky at the horizon, linear radiance"));
  visit("ground_colour", sky.ground_colour, radiance(1, "light from below, linear radiance"));
  visit("haze_colour", sky.haze_colour, radiance(2, "distant haze, linear radiance"));
  visit(
      "visibility_m", sky.visibility_m,
      in("m", {10, 1e7}, {500, 1e5}, "distance at which 2 % of the contrast remains, at height 0"));
  visit("haze_height_m", sky.haze_height_m,
        in("m", {1, 1e7}, {50, 5000}, "the haze thins by a factor of e over this height"));
  visit("exposure", sky.exposure,
        in("", {0.01, 100}, {0.1, 10}, "brightness of the image; doubling it is one stop"));
  visit("cloud_cover", sky.cloud_cover, fraction("0 clear, 1 overcast"));
  visit("day_length_s", sky.day_length_s,
        in("s", {0, 1e7}, {0, 3600}, "duration of 24 hours; 0: the sun does not move"));
  visit("start_hour", sky.start_hour,
        in("h", {0, 24}, {0, 24}, "hour of the day at the start; the sun is highest at 12"));
  visit("latitude_deg", sky.latitude_deg,
        in("degrees", {-80, 80}, {-80, 80}, "affects the sun's highest elevation"));
};

// The fields of Water.
inline constexpr auto visit_water = [](auto& water, const auto& visit) {
  visit("level_m", water.level_m, ground_height("water level; no water at -1000000 or below"));
  visit("colour", water.colour, fraction("deep water, linear albedo"));
  visit("shore_m", water.shore_m,
        in("m", {0, 1000}, {0, 20}, "height of the sand above the water level"));
};

// The fields of models::RiverSettings, but the seed, which is the world's.
inline constexpr auto visit_rivers = [](auto& rivers, const auto& visit) {
  visit("root_spacing_m", rivers.root_spacing_m,
        in("m", {256, 65'536}, {1000, 16'000},
           "distance of the largest rivers; the relief is about a quarter of it"));
  std::int64_t halvings = rivers.halvings;
  visit("halvings", halvings, in("", {1, 8}, {3, 8}, "levels of smaller rivers"));
  if constexpr (!std::is_const_v<std::remove_reference_t<decltype(rivers)>>)
    rivers.halvings = static_cast<int>(halvings);
  visit("channel_km2", rivers.channel_km2,
        in("km²", {1e-4, 1000}, {0.01, 2}, "drainage area from which on a stream has a bed"));
  visit("lake_share", rivers.lake_share,
        in("", {0, 0.12}, {0, 0.12}, "fraction of the land under lakes"));
  visit("mountain_share", rivers.mountain_share, fraction("mountains, of the land"));
  visit("sea_share", rivers.sea_share, fraction("sea, of the world"));
  visit("steepness", rivers.steepness, in("", {0.05, 3}, {0.2, 2}, "factor of all slopes"));
};

// The fields of Palette.
inline constexpr auto visit_palette = [](auto& palette, const auto& visit) {
  visit("grass", palette.grass, fraction("meadows, linear albedo"));
  visit("forest", palette.forest, fraction("ground under trees, linear albedo"));
  visit("dry", palette.dry, fraction("dry meadows, linear albedo"));
  visit("rock", palette.rock, fraction("bare rock, linear albedo"));
  visit("snow", palette.snow, fraction("snow, linear albedo"));
  visit("sand", palette.sand, fraction("sand, linear albedo"));
  visit("sand_end_m", palette.sand_end_m, ground_height("sand below this height"));
  visit("sand_blend_m", palette.sand_blend_m, blend("height range over which sand ends"));
  visit("dry_start_m", palette.dry_start_m, ground_height("dry meadow above this height"));
  visit("dry_blend_m", palette.dry_blend_m, blend("height range over which dry meadow begins"));
  visit("snow_start_m", palette.snow_start_m,
        ground_height("snow above this height, except on steep ground"));
  visit("snow_blend_m", palette.snow_blend_m, blend("height range over which snow begins"));
  visit("rock_slope_start", palette.rock_slope_start,
        fraction("slope at which bare rock begins: 0 flat, 0.29 at 45 degrees, 1 vertical"));
  visit("rock_slope_full", palette.rock_slope_full,
        fraction(
            "slope at which bare rock covers everything: 0 flat, 0.29 at 45 degrees, 1 vertical"));
  visit("snow_slope_max", palette.snow_slope_max,
        fraction("steeper ground has no snow: 0 flat, 0.29 at 45 degrees, 1 vertical"));
};

// The numbers of a HandmadeModel.
inline constexpr auto visit_handmade = [](auto& model, const auto& visit) {
  visit("size_m", model.size_m,
        in("m", {0, 1000}, {0, 50}, "height; 0: height in the file times scale"));
  visit("scale", model.scale,
        in("", {1e-6, 1e6}, {0.01, 100}, "size in the world over size in the file"));
  visit("sink_m", model.sink_m,
        in("m", {0, 100}, {0, 5}, "depth of its lowest point in the ground"));
  visit("levels", model.levels, in("", {1, 8}, {1, 8}, "maximum number of levels of detail"));
};

// The fields of a [[scatter]] that limit the positions of instances.
inline constexpr auto visit_place = [](auto& scatter, const auto& visit) {
  visit("min_height_m", scatter.min_height_m, ground_height("lowest ground with instances"));
  visit("max_height_m", scatter.max_height_m, ground_height("highest ground with instances"));
  visit("max_slope_deg", scatter.max_slope_deg,
        in("degrees", {0, 90}, {0, 90}, "steepest ground with instances"));
  visit("min_slope_deg", scatter.site.min_slope_deg,
        in("degrees", {0, 90}, {0, 60}, "flattest ground with instances"));
  visit("facing_deg", scatter.site.facing_deg,
        full_turn("direction that the ground falls in, from north towards east"));
  visit("facing_spread_deg", scatter.site.facing_spread_deg,
        in("degrees", {0, 180}, {0, 180}, "largest deviation from facing_deg; 180: any direction"));
  visit(
      "max_depth_m", scatter.max_depth_m,
      in("m", {0, 1e4}, {0, 5}, "deepest water with instances; default: none in rivers and lakes"));
  visit("near_water_m", scatter.near_water_m,
        in("m", {0.1, 1000}, {1, 50}, "instances stand at most this far from water"));
  visit("max_above_water_m", scatter.site.max_above_water_m,
        in("m", {0, 1000}, {0, 10}, "highest ground above the water that near_water_m finds"));
  visit("far_from_water_m", scatter.site.far_from_water_m,
        in("m", {0, 1000}, {0, 50}, "instances stand farther than this from water"));
  visit("near_road_m", scatter.site.near_road_m,
        in("m", {0.1, 1000}, {1, 50}, "instances stand at most this far from the edge of a road"));
  visit("far_from_road_m", scatter.site.far_from_road_m,
        in("m", {0, 1000}, {0, 50}, "instances stand farther than this from the edge of a road"));
  visit("beside_m", scatter.site.beside_m,
        in("m", {0, 1e5}, {0, 20}, "distance to an instance of the model that beside names"));
  visit("mask_fade", scatter.mask.fade,
        fraction("width of the borders of patches: 0 sharp, 1 over the whole patch"));
  visit("edge_size", scatter.site.edge_size,
        fraction("part of all ranges in metres that instances at the border of the mask use"));
  visit("spacing_m", scatter.spacing_m,
        in("m", {0, 1e5}, {0, 20},
           "diameter of a disc around each instance; discs of instances do not overlap"));
  visit("footprint_m", scatter.footprint_m,
        in("m", {0, 100}, {0, 20},
           "side of the square footprint: instances stand on the lowest ground below it"));
  visit("tilt", scatter.tilt, fraction("share of the ground's slope that grass leans by"));
};

// The numbers of a ScatterMask. Stamps have them too.
inline constexpr auto visit_mask = [](auto& mask, const auto& visit) {
  visit("mask_noise_m", mask.noise_m,
        in("m", {0, 1e6}, {0, 1000}, "size of the patches where it acts; 0: no patches"));
  visit("mask_share", mask.share, fraction("fraction of the ground that the patches cover"));
  visit("mask_patches", mask.patches,
        in("", {0, 1e6}, {0, 20},
           "random seed of the patches; equal seeds and sizes give equal patches"));
};

// The numbers of a Place, without the parameters of its model.
inline constexpr auto visit_placed = [](auto& place, const auto& visit) {
  visit("above_m", place.above_m,
        in("m", {-1000, 1000}, {-10, 100}, "height of its base point above the ground"));
};

// The numbers of a Stamp.
inline constexpr auto visit_stamp = [](auto& stamp, const auto& visit) {
  visit("turn_deg", stamp.turn_deg, full_turn("rotation about the vertical axis"));
  visit("base_m", stamp.base_m,
        in("m", {-1e5, 1e5}, {0, 100}, "height of black pixels, or of 0 m"));
  visit("height_m", stamp.height_m,
        in("m", {-1e5, 1e5}, {0, 100}, "height of white pixels above black ones; not for metres"));
  visit("border_m", stamp.border_m,
        in("m", {0, 20'000}, {0, 200}, "width of the fade inside the rectangle"));
};
inline constexpr FieldSpec kStampSize =
    in("m", {1, 20'000}, {10, 2000}, "side lengths along the image's rows and columns");
inline constexpr FieldSpec kNoData =
    in("", {-std::numeric_limits<double>::max(), std::numeric_limits<double>::max()},
       {-32'768, 65'535}, "number in the image that marks pixels without height");

// The strength of a Stamp or a Road.
inline constexpr auto visit_strength = [](auto& shape, const auto& visit) {
  visit("strength", shape.strength, fraction("fraction of the change of the ground"));
};
// The ranges of slow ground on which a Stamp acts.
inline constexpr auto visit_ranges = [](auto& stamp, const auto& visit) {
  visit("min_height_m", stamp.min_height_m, ground_height("lowest slow ground where it acts"));
  visit("max_height_m", stamp.max_height_m, ground_height("highest slow ground where it acts"));
  visit("height_fade_m", stamp.height_fade_m,
        in("m", {0, 1e6}, {0, 100}, "it begins and ends over this range of heights"));
  visit("min_slope_deg", stamp.min_slope_deg,
        in("degrees", {0, 90}, {0, 60}, "least steep slow ground where it acts"));
  visit("max_slope_deg", stamp.max_slope_deg,
        in("degrees", {0, 90}, {0, 60}, "steepest slow ground where it acts"));
  visit("slope_fade_deg", stamp.slope_fade_deg,
        in("degrees", {0, 90}, {0, 30}, "it begins and ends over this range of slopes"));
};

// The numbers of a Road.
inline constexpr auto visit_road = [](auto& road, const auto& visit) {
  visit("width_m", road.width_m, in("m", {0.5, 200}, {2, 30}, "width of the flat part"));
  visit("border_m", road.border_m,
        in("m", {0, 500}, {0, 50}, "on both sides: width of the transition to the ground"));
  visit("smoothing_m", road.smoothing_m,
        in("m", {0, 1000}, {0, 200}, "heights are averaged over this distance"));
  visit("clear_m", road.clear_m, in("m", {0, 100}, {0, 10}, "on both sides: strip without models"));
};

// The lists of a River, each one number or one for each point, and its numbers.
inline constexpr auto visit_river_lists = [](auto& river, const auto& visit) {
  visit("width_m", river.width_m,
        in("m", {kMinRiverM, kMaxRiverWidthM}, {2, 60},
           "width of the water: one number, or one for each point"));
  visit("depth_m", river.depth_m,
        in("m", {kMinDepthM, kMaxRiverDepthM}, {0.3, 8},
           "depth in the middle: one number, or one for each point"));
  visit("discharge_m3_s", river.discharge_m3_s,
        in("m³/s", {0, kMaxDischarge}, {0.1, 500},
           "discharge: one number, or one for each point; default: from width and depth"));
};
inline constexpr auto visit_river = [](auto& river, const auto& visit) {
  visit("bank_m", river.bank_m,
        in("m", {kMinRiverM, kMaxRiverBankM}, {2, 40},
           "on both sides: width of the slope up to the ground"));
  visit(
      "smoothing_m", river.smoothing_m,
      in("m", {0, kMaxSmoothingM}, {0, 200}, "steps of the surface are spread over this distance"));
};

// The numbers of a Lake.
inline constexpr auto visit_lake = [](auto& lake, const auto& visit) {
  visit("depth_m", lake.depth_m,
        in("m", {kMinDepthM, kMaxLakeDepthM}, {1, 40}, "depth away from the shore"));
  visit("shore_m", lake.shore_m,
        in("m", {1, kMaxShoreM}, {2, 60}, "width of the slopes on both sides of the outline"));
};
inline constexpr FieldSpec kLakeRadius =
    in("m", {1, kMaxLakeM / 2}, {10, 500}, "radius of a round lake");
inline constexpr FieldSpec kSpill =
    in("m", {-1e5, 1e5}, {0, 500}, "height of the surface; default: the lowest ground around it");

// The numbers of a world outside of its terrain.
inline constexpr FieldSpec kBlocks =
    in("blocks", {0, 0x1.0p31}, {0, 1024}, "number of blocks along x and z; 0: endless");
inline constexpr FieldSpec kCount =
    in("", {0, kMaxModelsPerBlock}, {0, 200}, "instances on each block");

// Parameters of the terrain that have these keys in the table [world], instead of [terrain].
struct TerrainAlias {
  std::string_view key, parameter;
};
inline constexpr TerrainAlias kWorldKeys[] = {{"cell_m", "cell_m"}, {"block_vertices", "size"}};
// True for parameters of the terrain that have keys in [terrain].
constexpr bool is_terrain_key(const models::ParameterSpec& spec) {
  return spec.source == models::ParameterSource::kUser &&
         std::ranges::find(kWorldKeys, spec.name, &TerrainAlias::parameter) == std::end(kWorldKeys);
}

}  // namespace psygen::world
