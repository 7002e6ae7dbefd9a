// Edits of the ground: raised, flattened, or shaped by a heightmap, at any position of the world.
// They act on the heights of the base terrain in order, as a pure function of the position, so that
// neighbouring nodes and all levels agree bit for bit at shared vertices. A value: copies are O(1)
// and independent. Any thread may read a value that no thread changes. Checks nothing (world/edits)
// and stores nothing.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/models/ground/ground_mask.hpp"
#include "engine/models/ground/water.hpp"
#include "engine/models/kit/quad_map.hpp"

namespace psygen::models {

class ErosionGuide;

// The change that an edit makes to the height under it.
enum class GroundChange : std::uint8_t {
  kRaise,     // adds height_m; below 0 it digs
  kFlatten,   // moves the height to height_m
  kStampAdd,  // adds the heightmap
  kStampSet,  // replaces the height by the heightmap
  kRoad,      // moves the height to the road's height
  kRiver,     // digs the bed and the banks of a river
  kLake,      // shapes the bed and the shore of a lake
};
constexpr bool is_water(GroundChange change) {
  return change == GroundChange::kRiver || change == GroundChange::kLake;
}
constexpr bool is_stamp(GroundChange change) {
  return change == GroundChange::kStampAdd || change == GroundChange::kStampSet;
}

// The part of its change that an edit makes.
enum class GroundBlend : std::uint8_t {
  kMix,      // all of it
  kHighest,  // only where the ground rises
  kLowest,   // only where the ground falls
};

// Heights in metres over a square, row by row from its corner at the least x and z. Linear between
// its points; the outer ones lie on the square's border.
struct Heightmap {
  std::uint32_t columns = 0, rows = 0;  // at least 2 each
  std::vector<float> heights_m;         // columns · rows
  bool has_holes = false;               // some are NaN: the ground stays there
};

// A straight segment of a road's centre line, in metres from the origin of the road, with its
// heights.
struct RoadSegment {
  glm::dvec2 from_m{0.0}, to_m{0.0};
  double from_height_m = 0, to_height_m = 0;
};

// A piece of a road. The nearest segment of the whole road, the first of equals, shapes a point, so
// exactly one piece does. All pieces of a road have the same origin, so they agree.
struct RoadPiece {
  core::WorldPosition origin;
  double half_width_m = 3;  // of the strip at the height of the road
  double border_m = 4;      // width beyond the strip over which the road fades out
  double clear_m = 1;       // width beyond the strip without models
  // The piece's own segments are `first` … `end` − 1; the list has all segments that may be nearer
  // to its points. In the order of the road.
  std::vector<RoadSegment> segments;
  std::size_t first = 0, end = 0;

  // Distance from the centre line to which the piece acts.
  double reach_m() const { return half_width_m + std::max(border_m, clear_m); }
};

// The effect of a piece of a road at a point, in metres from the road's origin: the height of the
// road and its weight, 0 … 1.
struct RoadEffect {
  double height_m = 0, weight = 0;
};
RoadEffect effect_of(const RoadPiece& road, glm::dvec2 place_m);
// Returns the fraction of road surface at a point, 0 … 1; its edge is 1 m wide.
double road_share(const RoadPiece& road, glm::dvec2 place_m);

// One edit. Immutable once it is part of a GroundEdits.
struct GroundEdit {
  GroundChange change = GroundChange::kRaise;
  bool square = false;         // else a disc; a stamp is always a square
  core::WorldPosition centre;  // normalised; y is not used
  double radius_m = 1;         // of the disc, or half the side of the square
  double falloff = 0.5;        // fraction of the radius over which the edit fades out; 0: a cliff
  // kRaise: difference; kFlatten: height above 0; kRoad, kRiver, kLake: largest height change.
  double height_m = 0;
  std::shared_ptr<const Heightmap> map;     // of the two stamps
  glm::dvec2 turn{1, 0};                    // of stamps: cosine and sine of a turn about +Y
  glm::dvec2 sides{1, 1};                   // of stamps in world files: half sides over the radius
  std::shared_ptr<const RoadPiece> road;    // of kRoad, whose square encloses the piece
  std::shared_ptr<const RiverPiece> river;  // of kRiver, as for roads
  std::shared_ptr<const LakePiece> lake;    // of kLake, as for roads
  double strength = 1;                      // fraction of the change, 0 … 1
  GroundBlend blend = GroundBlend::kMix;
  std::shared_ptr<const GroundMask> mask;  // fraction of the change at each place; null: all of it
  std::uint32_t id = 0;                    // unique in the block of the centre
  // Set by seal():
  std::uint64_t content = 0;  // identifies everything above
  float max_m = 0;            // largest height change; 1e30: limited by the height range only

  // Half the side of the axis-aligned square around the edit.
  double reach_m() const { return radius_m * (std::abs(turn.x) + std::abs(turn.y)); }
  // The position from which its curves count metres: of a road, a river or a lake, else the centre.
  const core::WorldPosition& origin() const {
    return road ? road->origin : river ? river->origin : lake ? lake->origin : centre;
  }
  // True if it makes its whole change everywhere.
  bool is_whole() const { return strength == 1 && blend == GroundBlend::kMix && !mask; }
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

// The edits whose influence begins in one square of the quadtree, in the order of their action.
struct GroundCell {
  std::vector<std::shared_ptr<const GroundEdit>> edits;

  // Largest change of heights by overlapping edits, and the largest slope of that change.
  struct Summary {
    float change_m = 0, steepness = 0;              // sum over this square's own edits
    float below_change_m = 0, below_steepness = 0;  // largest value of one of its quarters
    // Of all edits in the square: their areas, weighted by the time for a height, and by the
    // heights of the guide that their masks read for one.
    double work_m2 = 0, guide_m2 = 0;
    bool has_roads = false, has_water = false;
    void add(const Summary& quarter);
  };
  bool empty() const { return edits.empty(); }
  std::uint64_t hash() const;
  Summary summary() const;
};

// Estimate of the work of GroundEdits::apply() on a height, as a mean over a rectangle.
struct HeightWork {
  double edits = 0;        // in units of the time for a simple edit; a stamp counts as three
  double guide_reads = 0;  // heights of the guide that masks read
};

// Edits of the ground in the order of their action: the shapes of a world file, or those that a
// game makes (ground/stack.hpp).
class GroundEdits {
 public:
  // Light baked into vertices depends on an edit up to this many radii from its centre (light.hpp);
  // beyond, no mesh depends on it.
  static constexpr double kInfluence = 5.5;
  // Largest number of edits that begin in one square of the quadtree.
  static constexpr std::size_t kMaxTogether = 1024;

  // True without edits.
  bool empty() const { return cells_.empty(); }
  // True if both are copies of one value. O(1).
  bool is(const GroundEdits& other) const { return cells_.root() == other.cells_.root(); }

  // Adds a sealed edit, or removes the edit with this id and block, in O(log n + kMaxTogether).
  // add() returns false, and changes nothing, if the square already has kMaxTogether edits.
  bool add(const std::shared_ptr<const GroundEdit>& edit, double block_m);
  void remove(const GroundEdit& edit, double block_m);

  // Hash of all edits that can change the ground mesh of a node that needs heights `margin` blocks
  // beyond its border, combined with that of the layers below; 0: none. O(log n), and O(margin) for
  // large nodes.
  std::uint64_t hash_of(const QuadCoord& node, double margin, double block_m,
                        std::uint64_t below = 0) const;
  // True if both have the same edits there. May be false although they do; O(log n) after small
  // changes.
  static bool same_in(const GroundEdits& a, const GroundEdits& b, const QuadCoord& node,
                      double margin);
  // True if any edit may change heights within a node. May be true although none does.
  bool reaches(const QuadCoord& node, double block_m) const;
  // Returns the pieces of roads that may reach a node, each once. O(log n + p log p) for p pieces,
  // independent of all other edits.
  std::vector<const GroundEdit*> roads_in(const QuadCoord& node, double block_m,
                                          double margin = 0) const;
  // True if there is any river or lake. O(1).
  bool has_water() const { return !empty() && cells_.root()->summary.has_water; }
  // The same for pieces of rivers and lakes that may reach a node, or `margin` blocks beyond it.
  std::vector<const GroundEdit*> water_in(const QuadCoord& node, double block_m,
                                          double margin = 0) const;
  // Returns the surface of the river or lake that owns a place in a block; nothing: none reaches
  // it. O(log n + pieces around the place).
  std::optional<BodySurface> water_over(core::BlockCoord block, glm::dvec2 local_m,
                                        double block_m) const;
  // The largest change of heights by the edits that overlap anywhere in a node, and the largest
  // slope of that change. Upper bounds; 0: no edits.
  struct Change {
    double change_m = 0, steepness = 0;
  };
  Change max_change_in(const QuadCoord& node, double block_m) const;

  // Up to four times too high if edits are much smaller than the rectangle. O(log n + edits at its
  // border).
  HeightWork work_per_height(const GroundScale& scale, LatticeSpan x, LatticeSpan z) const;

  // Applies the edits to heights at the lattice points (x[i], z[k]), values[k · stride + i]. x and
  // z ascend. Skips edits of a radius below `narrowest_m`. Linear in the heights that change. Masks
  // of height and slope read `guide`, in the units of the values; null only if there are none.
  void apply(const GroundScale& scale, std::span<const std::int64_t> x,
             std::span<const std::int64_t> z, std::span<float> values, std::size_t stride,
             double narrowest_m = 0, const ErosionGuide* guide = nullptr) const;

 private:
  QuadMap<GroundCell> cells_;
};

// Metres from the origin of a road, a river or a lake to a point in a block.
glm::dvec2 from_origin_m(const core::WorldPosition& origin, core::BlockCoord block,
                         glm::dvec2 local_m, double block_m);
// True if a piece of a road keeps models away from a point in a block.
bool keeps_clear(const RoadPiece& road, core::BlockCoord block, glm::dvec2 local_m, double block_m);
// The distance from the strip of a piece of a road to a point in a block; 0 on the road.
double beside_road_m(const RoadPiece& road, core::BlockCoord block, glm::dvec2 local_m,
                     double block_m);

}  // namespace psygen::models
