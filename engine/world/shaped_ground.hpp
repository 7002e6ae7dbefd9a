// What a world's file does to its ground: stamps, which are heightmaps from pictures, and roads
// along smooth curves. They are part of the world's function: models find their places on the
// shaped ground, and edits lie over it (edits/edits.hpp). Plain values; immutable in use, any
// thread. They read no files (files/shaped_file.hpp). docs/world-files.md.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/models/model_type.hpp"
#include "engine/world/mask.hpp"

namespace psygen::world {

struct World;

// How a stamp acts on the ground: it is added to it, or takes its place.
inline constexpr std::array<std::string_view, 2> kStampModes{"add", "set"};

// A heightmap on a square of the ground. The outer pixels of its picture lie on the border.
struct Stamp {
  std::string image;  // relative to the folder of the world's file
  std::shared_ptr<const GreyPicture> picture;
  glm::dvec2 centre_m{0.0};  // x and z in the world
  double size_m = 200;       // side of the square
  double turn_deg = 0;       // about +Y, like models
  double base_m = 0;         // of black
  double height_m = 20;      // of white above black
  double border_m = 40;      // inside the square, over which it fades out
  std::string mode{kStampModes[0]};
  // Equal pictures are equal in content.
  friend bool operator==(const Stamp& a, const Stamp& b);
};

// A road: flat across, it follows the ground along a natural cubic spline through its points.
struct Road {
  std::vector<glm::dvec2> points_m;  // x and z in the world; at least two
  double width_m = 6;
  double border_m = 6;      // on both sides, over which it goes over into the ground
  double smoothing_m = 30;  // how calmly it follows the ground
  double clear_m = 1;       // on both sides, without models
  friend bool operator==(const Road&, const Road&) = default;
};

// Limits of a file. Points of a road lie at least kMinRoadStepM apart.
inline constexpr std::size_t kMaxStamps = 64, kMaxRoads = 64, kMaxRoadPoints = 1000;
inline constexpr double kMinRoadStepM = 1, kMaxRoadsM = 100'000;
inline constexpr double kFarthestShapeM = 1e8;  // from the world's origin along an axis

// All of it, and the layer of edits that it becomes.
struct ShapedGround {
  std::vector<Stamp> stamps;
  std::vector<Road> roads;
  // Made by shape_ground(); null: nothing. It follows from the world, and is not compared.
  std::shared_ptr<const models::EditLayer> layer;
  friend bool operator==(const ShapedGround& a, const ShapedGround& b) {
    return a.stamps == b.stamps && a.roads == b.roads;
  }
};

// What is wrong with which key of which stamp or road.
struct ShapeError {
  std::string_view place, key;  // "stamp" or "road"
  std::size_t number = 0;
  core::Error error;
};

// Makes the layer from stamps and roads, in this order, and takes away the world's edits. Requires
// world.terrain with its seed. Linear in heights of stamps and lengths of roads. Fails with
// kInvalidArgument for what lies outside of the world or rises beyond the relief, and with
// kOverBudget where too much lies on top of each other or all roads together are longer than
// kMaxRoadsM.
tl::expected<void, ShapeError> shape_ground(World& world);

// Of the whole shaped ground; 0: there is nothing.
std::uint64_t shape_hash(const World& world);

}  // namespace psygen::world
