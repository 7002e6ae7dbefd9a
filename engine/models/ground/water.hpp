// Rivers and lakes in the ground: pieces of a river's curve and tiles of a lake. Each shapes the
// ground under it as an edit does (ground_edits.hpp), and carries a surface of water. Pure
// functions of the place, without libm, so the bits are the same on every machine. Plain values,
// immutable in use, any thread. Made and checked by world/water_shapes; knows no sea.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "engine/core/coordinates.hpp"

namespace psygen::models {

// A point of a river's centre line, in metres from the river's origin. Values between two points
// are linear. surface_m and bed_m never rise from one point to the next, and bed_m <= surface_m.
struct RiverPoint {
  glm::dvec2 at_m{0.0};
  glm::dvec2 direction{1, 0};  // downstream, unit length
  double half_width_m = 3;     // of the water
  double surface_m = 0;        // height of the water
  double bed_m = 0;            // height of the ground in the middle
  double bank_m = 6;           // width of the slope beside the water, up to the ground
  double speed_m_s = 0;        // mean over the cross-section
  double fall = 0;             // slope of the surface downstream, at least 0
  double foam = 0;             // 0 … 1
  double discharge_m3_s = 0;   // tells, but shapes nothing
};
// The area of the water across a river; its depth is a parabola.
inline double cross_section_m2(const RiverPoint& p) {
  return 2 * p.half_width_m * std::max(p.surface_m - p.bed_m, 0.05) * 2 / 3;
}

// A segment of the same river that may be nearer to a place than the piece's own ones.
struct RiverNeighbour {
  glm::dvec2 from_m{0.0}, to_m{0.0};
  bool is_earlier = false;  // upstream of the piece; wins where both are equally near
  friend bool operator==(const RiverNeighbour&, const RiverNeighbour&) = default;
};

// A piece of a river: the places whose nearest segment of the whole river, the first of equals, is
// one of the piece's own. All pieces of a river have the same origin, so they agree.
struct RiverPiece {
  core::WorldPosition origin;
  std::uint32_t body = 0;            // the river's name in its world
  double edge_m = 2;                 // the surface reaches this far beyond the water's width
  std::vector<RiverPoint> points;    // at least 2, downstream: of the piece's own segments
  std::vector<RiverNeighbour> near;  // of other pieces
  // Set by seal():
  double reach_m = 0;                  // distance from the centre line to which the piece acts
  glm::dvec2 low_m{0.0}, high_m{0.0};  // the rectangle that it reaches
  std::vector<glm::dvec2> along;       // of own segments, then of neighbours: from end to end
  std::vector<double> per_length2;     // 1 over the squares of their lengths; 0: a point
};
// A straight segment of a lake's outline, in metres from the lake's origin, with the outside at
// (z, −x) of its direction. Each end has the mean of the outward normals of the segments that meet
// there, of any length above 0.
struct LakeSegment {
  glm::dvec2 from_m{0.0}, to_m{0.0};
  glm::dvec2 from_normal{0.0}, to_normal{0.0};
  double per_length2 = 0;  // set by seal(): 1 over the square of its length; 0: a point
};

// A tile of a lake: the places in a rectangle without its upper sides, in metres from the lake's
// origin. All tiles of a lake have the same origin, so exactly one tile owns a place.
struct LakePiece {
  core::WorldPosition origin;
  std::uint32_t body = 0;  // the lake's name in its world
  double level_m = 0;      // height of the water
  double depth_m = 4;      // of the bed, from shore_m inside the outline on
  double shore_m = 8;      // width of the slopes inside and outside of the outline
  double edge_m = 2;       // the surface reaches this far beyond the outline
  glm::dvec2 low_m{0.0}, high_m{0.0};
  bool inside = false;  // without segments: the tile is inside the outline, not outside
  std::vector<LakeSegment> segments;  // all that may be nearest to a place of the tile
};

// The weight of an effect `left_m` before its end, which fades out over the last `fades_m`: smooth,
// 0 … 1. Beyond its end 0, at an end without fading 1.
constexpr double faded(double left_m, double fades_m) {
  if (!(left_m >= 0)) return 0;
  if (left_m >= fades_m) return 1;
  const double t = left_m / fades_m;
  return t * t * (3 - 2 * t);
}

// Sets the last members of a piece from the others, once these are final.
void seal(RiverPiece& river);
void seal(LakePiece& lake);

// The height of the ground, in metres, after a river or a lake has shaped it. A river only digs; a
// lake also raises the ground beside it, up to its level. Unchanged outside of the piece.
double shaped_by(const RiverPiece& river, double ground_m, glm::dvec2 place_m);
double shaped_by(const LakePiece& lake, double ground_m, glm::dvec2 place_m);

// Bodies of a network have names from here on. Those of world files lie below 2^31, and those that
// games add from there on.
inline constexpr std::uint32_t kFirstNetworkBody = 0xC0000000U;

// The surface of a river or a lake over a place.
struct BodySurface {
  double surface_m = 0;
  glm::dvec2 slope{0.0};     // of the surface, along x and z
  glm::dvec2 flow_m_s{0.0};  // along x and z
  double foam = 0;           // 0 … 1
  std::uint32_t body = 0;
  std::optional<double> discharge_m3_s = std::nullopt;  // of a river
  double width_m = 0;                                   // of a river
  // Distance from the middle in widths of the body: 0 in the middle of a river, 0.5 at the border
  // of the water, −1 everywhere inside the outline of a lake.
  double widths = 0;

  bool is_river() const { return discharge_m3_s.has_value(); }  // else a lake
  bool is_of_network() const { return body >= kFirstNetworkBody; }
  // True if this body owns a place that both reach: the one that is nearer in its widths, then the
  // lower one, then the one of the smaller number.
  bool owns_before(const BodySurface& other) const;
};
std::optional<BodySurface> surface_of(const RiverPiece& river, glm::dvec2 place_m);
std::optional<BodySurface> surface_of(const LakePiece& lake, glm::dvec2 place_m);

// The foam of a river by the slope of its surface downstream, 0 … 1: none below 4 %, all at 40 %.
constexpr double foam_of_fall(double fall) {
  return faded(fall - 0.04, 0.36);
}

// Metres from the outline of a lake to a place in its tile, or on the tile's border; below 0
// inside.
double outside_m(const LakePiece& lake, glm::dvec2 place_m);
// The depth of the water so many metres outside the outline; 0 there, and where it ends.
double depth_of(const LakePiece& lake, double outside_m);

// True if a place lies between the banks of a river, or inside the outline of a lake.
bool is_in_bed(const RiverPiece& river, glm::dvec2 place_m);
bool is_in_bed(const LakePiece& lake, glm::dvec2 place_m);

// Hashes of all that shapes ground or water.
std::uint64_t content_of(const RiverPiece& river);
std::uint64_t content_of(const LakePiece& lake);

}  // namespace psygen::models
