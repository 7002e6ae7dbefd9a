// Erosion, stamps (heightmaps from images), roads (along smooth curves), lakes and rivers: the
// shapes that a world file gives its ground. They are part of the world's function: models find
// their positions on the shaped ground, and edits lie over it (edits/edits.hpp). Plain values;
// immutable in use, any thread. They read no files (files/shaped_file.hpp). docs/world-files.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/models/ground/erosion.hpp"
#include "engine/models/model_type.hpp"
#include "engine/models/network/settings.hpp"
#include "engine/world/mask.hpp"
#include "engine/world/water_bodies.hpp"

namespace psygen::world {

struct World;

// A stamp adds its heights to the ground, replaces the ground by them, or takes the higher or the
// lower of both.
inline constexpr std::array<std::string_view, 4> kStampModes{"add", "set", "highest", "lowest"};
// The numbers of its image are grey, from black to white, or heights in metres.
inline constexpr std::array<std::string_view, 2> kStampUnits{"grey", "m"};

// A heightmap on a rectangle of the ground. The outer pixels of its image lie on the border.
struct Stamp {
  std::string image;  // relative to the folder of the world's file
  std::shared_ptr<const HeightPicture> picture;
  glm::dvec2 centre_m{0.0};  // x and z in the world
  glm::dvec2 size_m{200.0};  // sides along the image's rows and columns
  double turn_deg = 0;       // about +Y, as for models
  double base_m = 0;         // height of black, or of 0 m
  double height_m = 20;      // height of white above black; not for metres
  double border_m = 40;      // width of the fade inside the rectangle
  double no_data =
      std::numeric_limits<double>::infinity();  // number without height; infinite: none
  std::string mode{kStampModes[0]};
  std::string unit{kStampUnits[0]};
  double strength = 1;  // fraction of the change of the ground
  bool enabled = true;  // else it changes nothing
  // It acts only here, as models/ground/ground_mask.hpp says. The mask has no kinds of ground. If
  // its area is all 0, its image covers the rectangle of the stamp.
  ScatterMask mask;
  double min_height_m = -std::numeric_limits<double>::infinity();
  double max_height_m = std::numeric_limits<double>::infinity();
  double height_fade_m = 20;
  double min_slope_deg = 0, max_slope_deg = 90, slope_fade_deg = 10;

  bool is_in_metres() const { return unit == kStampUnits[1]; }
  // True if a number of the image is a height.
  bool is_height(float number) const {
    return !std::isnan(number) && number != static_cast<float>(no_data);
  }
  // Compares images by content.
  friend bool operator==(const Stamp& a, const Stamp& b);
};

// A road: flat across, along a natural cubic spline through its points that follows the ground.
struct Road {
  std::vector<glm::dvec2> points_m;  // x and z in the world; at least two
  double width_m = 6;
  double border_m = 6;      // on both sides: width of the transition to the ground
  double smoothing_m = 30;  // heights are averaged over this distance
  double clear_m = 1;       // on both sides, without models
  double strength = 1;      // fraction of the change of the ground
  bool enabled = true;      // else there is no road
  friend bool operator==(const Road&, const Road&) = default;
};

// True if a shape may change the world. A road of strength 0 still has its surface.
inline bool acts(const Stamp& stamp) {
  return stamp.enabled && stamp.strength > 0;
}
inline bool acts(const auto& shape) {
  return shape.enabled;
}
inline bool any_acts(const auto& shapes) {
  return std::ranges::any_of(shapes, [](const auto& shape) { return acts(shape); });
}

// Limits of a file. Points of a road are at least kMinRoadStepM apart.
inline constexpr std::size_t kMaxStamps = 64, kMaxRoads = 64, kMaxRoadPoints = 1000;
inline constexpr double kMinRoadStepM = 1, kMaxRoadsM = 100'000;
inline constexpr double kFarthestShapeM = 1e8;  // from the world's origin along an axis

// A river network, erosion, stamps, roads, lakes and rivers, and the layer made of them.
struct ShapedGround {
  std::optional<models::RiverSettings> network;  // land that follows rivers; none: noise
  models::Erosion erosion;                       // acts before all shapes
  std::vector<Stamp> stamps;
  std::vector<Road> roads;
  std::vector<Lake> lakes;
  std::vector<River> rivers;
  // Made by shape_ground(); null: no shapes. Derived from the world, so it is not compared.
  std::shared_ptr<const models::EditLayer> layer;
  // Sentences about doubtful rivers, lakes and roads, made with the layer.
  std::vector<std::string> warnings;
  // True if none of its shapes acts.
  bool empty() const {
    return !any_acts(stamps) && !any_acts(roads) && !any_acts(lakes) && !any_acts(rivers);
  }
  // True if it may have water above the sea.
  bool has_water() const { return network || any_acts(lakes) || any_acts(rivers); }
  friend bool operator==(const ShapedGround& a, const ShapedGround& b) {
    return a.network == b.network && a.erosion == b.erosion && a.stamps == b.stamps &&
           a.roads == b.roads && a.lakes == b.lakes && a.rivers == b.rivers;
  }
};

// An error in one key of a shape.
struct ShapeError {
  std::string_view place, key;  // "stamp", "road", "lake", "river" or "rivers"
  std::size_t number = 0;
  core::Error error;
};

// Builds the layer from the erosion, stamps, then roads, lakes and rivers (water_shapes.hpp), and
// removes the world's edits. world.terrain must already have its seed, and shapes have values that
// a file may have. Linear in the heights of stamps, the lengths of roads and the areas of water.
// Fails with kInvalidArgument for shapes outside the world or above its height range, and with
// kOverBudget where too many shapes overlap or all roads or rivers together are longer than
// kMaxRoadsM and kMaxRiversM.
tl::expected<void, ShapeError> shape_ground(World& world);

// A hash of all shapes; 0: there are none.
std::uint64_t shape_hash(const World& world);

// The least and the largest number of a stamp's image that are heights. The least is above the
// largest if there are none. Requires its picture.
std::pair<float, float> numbers_of(const Stamp& stamp);

}  // namespace psygen::world
