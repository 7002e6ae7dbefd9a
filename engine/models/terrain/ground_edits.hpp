// Edits of the ground: raised, flattened, or shaped by a heightmap, at places anywhere in the
// world. They act on the heights of the base terrain, one after the other, as a pure function of
// the place, so that neighbouring nodes and all levels agree bit for bit at shared vertices.
// A value: copies are O(1) and independent. Any thread may read one that nobody changes. Checks
// nothing (world/edits) and stores nothing.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/models/kit/quad_map.hpp"

namespace psygen::models {

// What an edit does with the height under it.
enum class GroundChange : std::uint8_t {
  kRaise,     // adds height_m; below 0 it digs
  kFlatten,   // moves it to height_m
  kStampAdd,  // adds the heightmap
  kStampSet,  // replaces it by the heightmap
  kRoad,      // moves it to the height of a road
};
constexpr bool is_stamp(GroundChange change) {
  return change == GroundChange::kStampAdd || change == GroundChange::kStampSet;
}

// Heights in metres over a square, row by row from its corner at the least x and z. Linear between
// its points; the outer ones lie on the square's border.
struct Heightmap {
  std::uint32_t columns = 0, rows = 0;  // at least 2 each
  std::vector<float> heights_m;         // columns · rows
};

// A straight part of a road's middle, in metres from the origin of the road, with its heights.
struct RoadSegment {
  glm::dvec2 from_m{0.0}, to_m{0.0};
  double from_height_m = 0, to_height_m = 0;
};

// A piece of a road. A place belongs to the nearest segment of the whole road, the first of equals,
// so exactly one piece shapes it. All pieces of a road have the same origin, so they agree.
struct RoadPiece {
  core::WorldPosition origin;
  double half_width_m = 3;  // of what has the height of the road
  double border_m = 4;      // beyond it, over which the road fades out
  double clear_m = 1;       // beyond it, where no models stand
  // Its own ones, `first` … `end` − 1, among all that may be nearer to its places. In the order of
  // the road.
  std::vector<RoadSegment> segments;
  std::size_t first = 0, end = 0;

  // How far it reaches from its middle.
  double reach_m() const { return half_width_m + std::max(border_m, clear_m); }
};

// What a piece of a road does at a place, in metres from the road's origin: the height of the road
// and its weight, 0 … 1.
struct RoadEffect {
  double height_m = 0, weight = 0;
};
RoadEffect effect_of(const RoadPiece& road, glm::dvec2 place_m);
// How much of the ground there is the road, 0 … 1: its edge is 1 m wide.
double road_share(const RoadPiece& road, glm::dvec2 place_m);

// One edit. Immutable once it is part of a GroundEdits.
struct GroundEdit {
  GroundChange change = GroundChange::kRaise;
  bool square = false;         // else a disc; a stamp is always a square
  core::WorldPosition centre;  // normalised; y is not used
  double radius_m = 1;         // of the disc, or half the side of the square
  double falloff = 0.5;        // share of the radius over which the edit fades out; 0: a cliff
  // kRaise: difference; kFlatten: height above 0; kRoad: how far it moves heights at most.
  double height_m = 0;
  std::shared_ptr<const Heightmap> map;   // of the two stamps
  glm::dvec2 turn{1, 0};                  // of stamps: cosine and sine of a turn about +Y
  std::shared_ptr<const RoadPiece> road;  // of kRoad, which is a square around the piece
  std::uint32_t id = 0;                   // unique in the block of the centre
  // Set by seal():
  std::uint64_t content = 0;  // identifies everything above
  float max_m = 0;  // how far it moves a height at most; 1e30: as far as the relief allows

  // Half the side of the square along the axes that holds all of it.
  double reach_m() const { return radius_m * (std::abs(turn.x) + std::abs(turn.y)); }
  // Edits act in this order.
  std::pair<std::uint32_t, core::BlockCoord> order() const { return {id, centre.block}; }
};
// Sets the last two members of an edit from the others, once these are final. Linear in the
// heightmap.
void seal(GroundEdit& edit);

// The lattice of a terrain and its heights: vertices are counted in cells of node level 0.
struct GroundScale {
  std::int64_t cells_per_block = 63;
  double cell_m = 1;
  double unit_m = 1;  // a height of 1 in metres
  float highest = 1;  // heights lie in [0, highest]
  double block_m() const { return static_cast<double>(cells_per_block) * cell_m; }
};

// A range of a lattice along one axis: coordinates of vertices, both included.
struct LatticeSpan {
  std::int64_t first = 0, last = 0;
};

// The edits whose influence begins in one square of the quadtree, in the order in which they act.
struct GroundCell {
  std::vector<std::shared_ptr<const GroundEdit>> edits;

  // How much heights may change where most edits lie on top of each other, and how steeply.
  struct Summary {
    float change_m = 0, steepness = 0;              // of this square's own edits, added up
    float below_change_m = 0, below_steepness = 0;  // the most in one of its quarters
    double work_m2 = 0;  // of all edits in it: their areas, weighted by the time for a height
    bool has_roads = false;
    void add(const Summary& quarter);
  };
  bool empty() const { return edits.empty(); }
  std::uint64_t hash() const;
  Summary summary() const;
};

// All edits of the ground of a world. Others may lie below them, which act first; they are part of
// everything but add() and remove().
class GroundEdits {
 public:
  // Light baked into vertices reaches this many radii from an edit's centre (light.hpp); beyond, no
  // mesh depends on it.
  static constexpr double kInfluence = 5.5;
  // Largest number of edits that begin in one square of the quadtree.
  static constexpr std::size_t kMaxTogether = 1024;

  // Whether there is no edit.
  bool empty() const { return cells_.empty() && below_.empty(); }

  // These edits over those of `below`, and these alone. O(1).
  GroundEdits over(const GroundEdits& below) const {
    GroundEdits both = *this;
    both.below_ = below.cells_;
    return both;
  }
  GroundEdits own() const { return over({}); }
  bool lies_on(const GroundEdits& below) const { return below_.root() == below.cells_.root(); }

  // Adds a sealed edit, or takes the one with this id and block away, in O(log n + kMaxTogether).
  // add() returns false, and changes nothing, where kMaxTogether are there already.
  bool add(const std::shared_ptr<const GroundEdit>& edit, double block_m);
  void remove(const GroundEdit& edit, double block_m);

  // Hash of all edits that can change the ground mesh of a node that needs heights `margin` blocks
  // beyond its border; 0: none. O(log n), and O(margin) for large nodes.
  std::uint64_t hash_of(const QuadPlace& node, double margin, double block_m) const;
  // Whether both have the same there. May say no although they have; O(log n) after small changes.
  static bool same_in(const GroundEdits& a, const GroundEdits& b, const QuadPlace& node,
                      double margin);
  // Whether any edit may change heights within a node. May say yes although none does.
  bool reaches(const QuadPlace& node, double block_m) const;
  // The pieces of roads that may reach a node, each once. Of p pieces there O(log n + p log p),
  // however many other edits there are.
  std::vector<const GroundEdit*> roads_in(const QuadPlace& node, double block_m) const;
  // How far the ground may lie off a mesh of the node whose vertices are `spacing_m` apart, because
  // of edits between them. An upper bound in metres; 0: there are none.
  double error_m(const QuadPlace& node, double spacing_m, double block_m) const;

  // About how many edits apply() makes on a height, on average over the rectangle, in units of the
  // time for a simple one; a stamp counts as three. Up to four times too many where edits are much
  // smaller than the rectangle. O(log n + edits at its border).
  double edits_per_height(const GroundScale& scale, LatticeSpan x, LatticeSpan z) const;

  // Applies the edits to heights at the lattice points (x[i], z[k]), values[k · stride + i]. x and
  // z ascend. Edits of a radius below `narrowest_m` are left out. Linear in the heights that
  // change.
  void apply(const GroundScale& scale, std::span<const std::int64_t> x,
             std::span<const std::int64_t> z, std::span<float> values, std::size_t stride,
             double narrowest_m = 0) const;

 private:
  QuadMap<GroundCell> cells_, below_;
};

// Metres from the origin of a road to a place in a block.
glm::dvec2 from_origin_m(const RoadPiece& road, core::BlockCoord block, glm::dvec2 local_m,
                         double block_m);
// Whether a piece of a road keeps models away from a place in a block.
bool keeps_clear(const RoadPiece& road, core::BlockCoord block, glm::dvec2 local_m, double block_m);

}  // namespace psygen::models
