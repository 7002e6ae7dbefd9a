// The fields of sky, water and palette in one place, for reading and for writing. Each visitor
// calls visit(name, field, limits) for every field, in the order of the file. It reads no text
// (table_reader.hpp). Internal to world.
#pragma once

#include "engine/world/files/table_reader.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

inline constexpr Limits kAnyHeight{-1e7, 1e7};  // metres
inline constexpr Limits kBlend{0.01, 1e6};      // metres
inline constexpr Limits kRadiance{0, 1000};
inline constexpr Limits kShare{0, 1};

// The fields of Sky.
template <class S, class Visit>
void visit_sky(S& sky, const Visit& visit) {
  visit("sun_azimuth_deg", sky.sun_azimuth_deg, Limits{-360, 360});
  visit("sun_elevation_deg", sky.sun_elevation_deg, Limits{-90, 90});
  visit("sun_colour", sky.sun_colour, kRadiance);
  visit("zenith_colour", sky.zenith_colour, kRadiance);
  visit("horizon_colour", sky.horizon_colour, kRadiance);
  visit("ground_colour", sky.ground_colour, kRadiance);
  visit("haze_colour", sky.haze_colour, kRadiance);
  visit("visibility_m", sky.visibility_m, Limits{10, 1e7});
  visit("haze_height_m", sky.haze_height_m, Limits{1, 1e7});
  visit("exposure", sky.exposure, Limits{0.01, 100});
  visit("cloud_cover", sky.cloud_cover, kShare);
  visit("day_length_s", sky.day_length_s, Limits{0, 1e7});
  visit("start_hour", sky.start_hour, Limits{0, 24});
  visit("latitude_deg", sky.latitude_deg, Limits{-80, 80});
}

// The fields of Water.
template <class W, class Visit>
void visit_water(W& water, const Visit& visit) {
  visit("level_m", water.level_m, kAnyHeight);
  visit("colour", water.colour, kShare);
  visit("shore_m", water.shore_m, Limits{0, 1000});
}

// The fields of Palette.
template <class P, class Visit>
void visit_palette(P& palette, const Visit& visit) {
  visit("grass", palette.grass, kShare);
  visit("forest", palette.forest, kShare);
  visit("dry", palette.dry, kShare);
  visit("rock", palette.rock, kShare);
  visit("snow", palette.snow, kShare);
  visit("sand", palette.sand, kShare);
  visit("sand_end_m", palette.sand_end_m, kAnyHeight);
  visit("sand_blend_m", palette.sand_blend_m, kBlend);
  visit("dry_start_m", palette.dry_start_m, kAnyHeight);
  visit("dry_blend_m", palette.dry_blend_m, kBlend);
  visit("snow_start_m", palette.snow_start_m, kAnyHeight);
  visit("snow_blend_m", palette.snow_blend_m, kBlend);
  visit("rock_slope_start", palette.rock_slope_start, kShare);
  visit("rock_slope_full", palette.rock_slope_full, kShare);
  visit("snow_slope_max", palette.snow_slope_max, kShare);
}

// Parameters of the terrain that the table [world] has under these keys, instead of [terrain].
struct TerrainAlias {
  std::string_view key, parameter;
};
inline constexpr TerrainAlias kWorldKeys[] = {{"cell_m", "cell_m"}, {"block_vertices", "size"}};

// Of the filters of a [[scatter]].
inline constexpr Limits kPlaceHeights{-1e7, 1e7};  // metres
inline constexpr Limits kSlopes{0, 90};            // degrees

}  // namespace psygen::world
