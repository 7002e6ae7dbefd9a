// A world definition: a few numbers that define terabytes of geometry (paper, section 4.1). Read
// from and written to TOML files (files/world_file.hpp). Plain values; valid if read from a file.
// It has no geometry: modelers synthesise that from the parameters. Immutable in use, so any thread
// may read.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/models/registry.hpp"
#include "engine/models/tree/species.hpp"
#include "engine/world/mask.hpp"
#include "engine/world/places.hpp"
#include "engine/world/shaped_ground.hpp"

namespace psygen::models {
class RiverNetwork;
}

namespace psygen::world {

inline constexpr int kWorldFormat = 1;  // version of the file format
inline constexpr std::uint32_t kMaxModelsPerBlock = 16'384;

// A parameter of one instance is drawn uniformly from [low, high]; integers include both ends.
struct ParameterRange {
  double low = 0, high = 0;
  friend bool operator==(const ParameterRange&, const ParameterRange&) = default;
};

// Collider of a handmade model: the hull of its points, their box, or none.
inline constexpr std::array<std::string_view, 3> kHandmadeColliders{"hull", "box", "none"};

// A handmade model: a glTF file, with its size and its position relative to the ground.
struct HandmadeModel {
  std::string name;   // of its model type
  std::string file;   // relative to the folder of the world's file
  double size_m = 0;  // height; 0: that of the file, times `scale`
  double scale = 1;
  double sink_m = 0;        // depth of its lowest point in the ground
  std::int64_t levels = 5;  // maximum number of levels of detail
  std::string collider{kHandmadeColliders[0]};
  friend bool operator==(const HandmadeModel&, const HandmadeModel&) = default;
};

// Further rules for the places of the instances of a scatter (place_search.hpp).
struct SiteRules {
  double min_slope_deg = 0;  // of the ground, from the horizontal
  // Direction that the ground falls in, from north towards east, and the largest deviation from it.
  // Ground flatter than kFlatDeg faces all directions.
  double facing_deg = 0, facing_spread_deg = 180;
  static constexpr double kFlatDeg = 3;
  double far_from_water_m = 0;  // in the plane; 0: any distance
  // Height of the ground above the water that Scatter::near_water_m asks for.
  double max_above_water_m = std::numeric_limits<double>::infinity();
  // Distances from the edges of roads; 0 and infinity: any.
  double far_from_road_m = 0, near_road_m = std::numeric_limits<double>::infinity();
  // Distance to a standing instance of one of the scatters `beside`, bits 1 << their index; 0: no
  // rule. They come earlier in the world, and keep apart by at least as much.
  double beside_m = 0;
  std::uint64_t beside = 0;
  // Scale of the upper ends of all ranges in metres at the border of the mask; 1: no scale.
  double edge_size = 1;

  // True if any rule excludes ground.
  bool limits_places() const {
    SiteRules places = *this;
    places.edge_size = 1;
    return places != SiteRules{};
  }
  bool limits_facing() const { return facing_spread_deg < 180; }
  bool asks_for_roads() const {
    return far_from_road_m > 0 || near_road_m < std::numeric_limits<double>::infinity();
  }
  friend bool operator==(const SiteRules&, const SiteRules&) = default;
};
// A hash of the rules that decide where instances stand; 0 without such rules.
std::uint64_t site_hash(const SiteRules& site);

// A model type that is scattered over every block.
struct Scatter {
  models::ModelIndex model = 0;
  std::uint32_t count = 0;             // instances per block
  std::vector<ParameterRange> ranges;  // one per parameter of the schema; kPlaced ones are unused
  // Limits of the ground under an instance. An instance that finds no such position is skipped
  // (placement.hpp).
  double min_height_m = -std::numeric_limits<double>::infinity();
  double max_height_m = std::numeric_limits<double>::infinity();
  double max_slope_deg = 90;  // of the ground, from the horizontal
  // Limits of the water of the world's function: the depth at the instance, and the distance to
  // water in the plane. Without a maximum depth, instances stand in the sea but in no river or
  // lake.
  double max_depth_m = std::numeric_limits<double>::infinity();
  double near_water_m = std::numeric_limits<double>::infinity();
  ScatterMask mask;  // further restriction within these limits
  SiteRules site;
  // Diameter of the disc around each instance that overlaps no disc of another instance with a
  // spacing (spacing.hpp); 0: none. `count` is then the number of candidates.
  double spacing_m = 0;
  // Side of the square foot, along the axes: an instance stands on the lowest ground below it; 0:
  // on that below its middle.
  double footprint_m = 0;
  double tilt = 1;  // share of the ground's slope, for types with a slope
  bool keeps_apart() const { return spacing_m > 0; }
  bool limits_depth() const { return max_depth_m < std::numeric_limits<double>::infinity(); }
  bool is_beside() const { return site.beside_m > 0; }
  // Distance in which water decides about a place.
  double water_reach_m() const {
    return std::max(needs_water() ? near_water_m : 0, site.far_from_water_m);
  }
  bool needs_water() const { return near_water_m < std::numeric_limits<double>::infinity(); }
  // True if any limit or mask excludes ground.
  bool has_filter() const {
    return mask.thins() || mask.ground != 0 ||
           min_height_m > -std::numeric_limits<double>::infinity() ||
           max_height_m < std::numeric_limits<double>::infinity() || max_slope_deg < 90 ||
           limits_depth() || needs_water() || site.limits_places();
  }
  friend bool operator==(const Scatter&, const Scatter&) = default;
};

// The position of the sun: azimuth from −Z (north) over +X (east), elevation above the horizon.
struct SunPlace {
  double azimuth_deg = 0, elevation_deg = 0;
  glm::vec3 direction() const;  // unit vector towards the sun
};

// Sun, sky and air. Colours are linear radiance before `exposure`, valid for the sun's elevation
// given here.
struct Sky {
  double sun_azimuth_deg = 128;  // from −Z (north) over +X (east)
  double sun_elevation_deg = 44;
  glm::vec3 sun_colour{3.1F, 2.75F, 2.25F};
  glm::vec3 zenith_colour{0.13F, 0.28F, 0.62F};
  glm::vec3 horizon_colour{0.50F, 0.62F, 0.78F};
  glm::vec3 ground_colour{0.16F, 0.15F, 0.11F};  // light from below
  glm::vec3 haze_colour{0.66F, 0.72F, 0.80F};
  double visibility_m = 32000;  // distance at height 0 at which 2 % of the contrast is left
  double haze_height_m = 1200;  // the haze thins by a factor e over this height
  double exposure = 1;
  double cloud_cover = 0.5;  // 0 clear … 1 overcast
  double day_length_s = 0;   // seconds for 24 hours; 0: the sun stays at the two angles
  double start_hour = 9;     // hour of the day at time 0; the sun is highest at 12
  double latitude_deg = 42;  // affects the sun's highest elevation

  // The position of the sun at a time; and the unit vector towards the sun at the two angles.
  SunPlace sun_at(double time_s) const;
  glm::vec3 sun_direction() const {
    return SunPlace{sun_azimuth_deg, sun_elevation_deg}.direction();
  }
  // Extinction at height 0 in 1/m, by Koschmieder's law.
  double haze_density() const { return 3.912 / visibility_m; }
  friend bool operator==(const Sky&, const Sky&) = default;
};

// The same air with the sun at another position. Colours change by the ratios of the atmosphere
// (atmosphere.hpp); at the same elevation no colour changes.
Sky with_sun(const Sky& sky, SunPlace sun);
// The sky at a time, in seconds.
inline Sky sky_at(const Sky& sky, double time_s) {
  return with_sun(sky, sky.sun_at(time_s));
}

// A plane of water; absent by default.
struct Water {
  double level_m = -1e7;  // height of the surface in metres of the world; below −10^6: no water
  glm::vec3 colour{0.010F, 0.045F, 0.050F};  // of deep water: linear albedo
  double shore_m = 1.5;                      // height of the beach above the water
  // True if there is water.
  bool exists() const { return level_m > -1e6; }
  friend bool operator==(const Water&, const Water&) = default;
};

// The keys of Palette::images in world files, in the order of GroundKind.
inline constexpr std::array<std::string_view, 6> kPaletteImages{
    "grass_image", "forest_image", "dry_image", "sand_image", "rock_image", "snow_image"};

// Linear albedos of the ground, and the range of each kind of ground. Heights are in metres of the
// world; slopes are 1 − normal.y: 0 flat, 0.29 at 45°, 1 vertical.
struct Palette {
  glm::vec3 grass{0.085F, 0.125F, 0.030F};
  glm::vec3 forest{0.045F, 0.070F, 0.022F};
  glm::vec3 dry{0.200F, 0.165F, 0.075F};
  glm::vec3 rock{0.175F, 0.160F, 0.145F};
  glm::vec3 snow{0.80F, 0.83F, 0.88F};
  glm::vec3 sand{0.36F, 0.30F, 0.19F};
  double sand_end_m = -1e6, sand_blend_m = 2;    // sand below this height
  double dry_start_m = 60, dry_blend_m = 40;     // dry meadow above this height
  double snow_start_m = 1e6, snow_blend_m = 15;  // snow above this height, except where steep
  double rock_slope_start = 0.16, rock_slope_full = 0.34;
  double snow_slope_max = 0.40;  // steeper ground has no snow
  // Images that replace the textures: names relative to the folder of the world file, or empty.
  std::array<std::string, kPaletteImages.size()> images;
  friend bool operator==(const Palette&, const Palette&) = default;
};

// Counts the replacements of a world in place: queries and physics that see another number than
// before forget everything derived from the world. Equal worlds may have different numbers.
struct Revision {
  std::uint64_t number = 0;
  friend bool operator==(const Revision&, const Revision&) { return true; }
};

// A whole world: a function, and the edits over it.
struct World {
  int format = kWorldFormat;
  std::string name;
  std::uint64_t seed = 1;
  std::int64_t blocks_x = 512, blocks_z = 512;  // 0: endless; else blocks 0 … n − 1 exist
  models::ModelIndex terrain_model = 0;
  models::Parameters terrain;            // of the block (0, 0)
  std::vector<models::Species> species;  // defined by the file; also types of the registry
  std::vector<HandmadeModel> models;     // as `species`
  std::vector<Scatter> scatter;
  ShapedGround shaped;  // stamps and roads; part of the function
  Places places;        // models placed by the file; part of the function
  Sky sky;
  Water water;
  Palette palette;
  // Changes made by hand (edits/edits.hpp), over the shaped ground; null: none. Not part of world
  // files. `terrain` refers to the same layer, so change it with set_edits().
  std::shared_ptr<const models::EditLayer> edits;
  // Increase it after changes of anything but edits and sky while queries refer to the world;
  // Scene::set_world() does. Not part of world files.
  Revision revision;
  // A hash of the contents of the files named here (handmade::hash_of_files()) if it was requested,
  // else 0. Not part of world files.
  std::uint64_t files_hash = 0;

  // True if an erosion or a network makes heights cost about ten times as much as those of noise.
  bool has_costly_heights() const;
  // The layer over the terrain's function: the edits, or the shaped ground if there are no edits;
  // null: neither.
  const std::shared_ptr<const models::EditLayer>& layer() const {
    return edits ? edits : shaped.layer;
  }

  // The river network of the ground; null: none.
  const models::RiverNetwork* network() const;

  double block_size_m() const;  // metres along one side of a block
  double cell_m() const;        // distance of neighbouring terrain vertices
  // The position of a place, x and z in metres from the corner of block (0, 0), at height 0.
  core::WorldPosition position(glm::dvec2 at_m) const {
    return core::normalised({{0, 0}, {at_m.x, 0, at_m.y}}, block_size_m());
  }
  // The inverse: x and z of a position, in metres from the corner of block (0, 0).
  glm::dvec2 metres(const core::WorldPosition& at) const {
    const double block_m = block_size_m();
    return {at.block.x * block_m + at.local.x, at.block.z * block_m + at.local.z};
  }
  // True if a block exists; true if the world is endless along any axis.
  bool contains(core::BlockCoord block) const;
  bool is_endless() const { return blocks_x == 0 || blocks_z == 0; }
  // The first block along an axis of `blocks` blocks, and the one behind the last. An endless axis
  // ends at its seam, where block indices wrap: nothing moves across it.
  static constexpr std::pair<std::int64_t, std::int64_t> ends(std::int64_t blocks) {
    constexpr std::int64_t kSeam = std::int64_t{1} << 31;
    return blocks == 0 ? std::pair{-kSeam, kSeam} : std::pair{std::int64_t{0}, blocks};
  }
  friend bool operator==(const World&, const World&) = default;
};

// Returns the same place in blocks of `to_m` instead of `from_m` metres, both counted from the
// corner of block (0, 0): for positions that outlive a world with blocks of another size.
// Normalised, unless the sizes are equal. Block indices wrap at 2^32.
core::WorldPosition rebased(const core::WorldPosition& at, double from_m, double to_m);

// The height of the ground at a position, or of the water above it, in metres of the world. Ignores
// the position's own height. engine/query answers exact questions about drawn ground.
double surface_height_m(const World& world, const core::WorldPosition& at);

// Replaces the edits of a world; null: none. They then include its shaped ground: if there is any,
// World::edits differs from `edits`. O(1).
void set_edits(World& world, std::shared_ptr<const models::EditLayer> edits);

// The palette for drawing and exporting ground: World::palette with sand on the shore of the water.
Palette drawn_palette(const World& world);

// The size of the world if all of it were generated at full detail. Terrain counts without its
// skirts. An endless world has 0 blocks, models, triangles and bytes.
struct WorldSize {
  std::uint64_t blocks = 0;
  std::uint64_t models = 0;  // at most 2^64 − 1
  double triangles = 0;
  double bytes = 0;        // packed vertices and indices; without shared index lists
  double bytes_paper = 0;  // 256 bytes per triangle, as in the paper
  bool endless = false;
  // Means per block, also for endless worlds.
  double block_models = 0, block_triangles = 0, block_bytes = 0;
};

// The size of a world, computed without synthesis. Exact for models whose size depends on no random
// parameter (terrain, rocks with a fixed subdivision). For other models it is the mean over
// kSizeSamples parameter sets, always the same ones. With filters, the fraction of instances that
// find a position is measured on kSizeBlocks blocks. Models placed by hand do not count.
inline constexpr std::uint32_t kSizeSamples = 1024;
inline constexpr std::uint32_t kSizeBlocks = 64;
WorldSize world_size(const World& world, const models::Registry& registry);

}  // namespace psygen::world
