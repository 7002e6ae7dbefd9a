// What the ground of one square tile needs of a river network: the nodes with the radii of their
// kernels, the channels as curves, and the lakes. A patch is a function of its key alone, complete
// before anybody reads it, and immutable after: any thread may read it. Several patches that cover
// a point give it the same bits, because every spot and curve is cut by its own distance.
#pragma once

#include <algorithm>
#include <bit>
#include <compare>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/models/network/curve.hpp"
#include "engine/models/network/halving.hpp"

namespace psygen::models::network {

// Cells between the points of the guide. Its cubic interpolation defines the fine ground. Places
// read points of the guide up to kGuideReach away.
constexpr std::int32_t kGuideCells = 4;
constexpr std::int32_t kGuideUnits = kGuideCells * static_cast<std::int32_t>(kUnitsPerCell);
constexpr std::int32_t kGuideReach = 3 * kGuideUnits;

// A node's kernel: weight gain · (1 − r²/R²)⁴ within R. Streams weigh more, so that the ground
// falls towards them.
struct Spot {
  std::int32_t x = 0, z = 0;  // units from the patch's origin
  float height_m = 0;
  float inverse_reach2 = 0;  // 1/R², per unit²
  float gain = 1;
  float depth_m = 0;       // of a lake
  std::int32_t reach = 0;  // R, units, rounded up
  std::int32_t lake = -1;  // index in Patch::lakes
};

// A lake: all its spots share the level.
struct Lake {
  float level_m = 0;
  std::uint32_t body = 0;
  friend auto operator<=>(const Lake&, const Lake&) = default;
};

// An axis-aligned rectangle of units from a patch's origin, both ends included.
struct Box {
  std::int32_t x0 = 0, z0 = 0, x1 = 0, z1 = 0;

  // The box with a border of this width.
  Box grown(std::int32_t by) const { return {x0 - by, z0 - by, x1 + by, z1 + by}; }
  bool holds(std::int32_t x, std::int32_t z) const {
    return x >= x0 && x <= x1 && z >= z0 && z <= z1;
  }
};

// The spots or curves that reach each of kSide² squares of a patch, as bits. Squares differ from
// patch to patch, so only Patch reads them: it cuts each by its own distance.
class ReachBins {
 public:
  static constexpr std::int32_t kSide = 8;

  // For `count` things in squares of this side, from the patch's origin on.
  ReachBins(std::size_t count, std::int32_t side)
      : words_((count + 63) / 64), side_(side), bits_(words_ * kSide * kSide) {}
  ReachBins() = default;
  void add(std::size_t thing, const Box& reach) {
    each(reach, [&](std::size_t square) {
      bits_[square * words_ + thing / 64] |= std::uint64_t{1} << (thing % 64);
    });
  }
  // Calls visit(thing), ascending, for all that may reach a box.
  template <class Visit>
  void find(const Box& box, const Visit& visit) const {
    for (std::size_t w = 0; w < words_; ++w) {
      std::uint64_t found = 0;
      each(box, [&](std::size_t square) { found |= bits_[square * words_ + w]; });
      for (; found != 0; found &= found - 1)
        visit(w * 64 + static_cast<std::size_t>(std::countr_zero(found)));
    }
  }
  std::size_t bytes() const { return bits_.capacity() * sizeof(std::uint64_t); }

 private:
  template <class Visit>
  void each(const Box& box, const Visit& visit) const {
    const auto square = [&](std::int32_t v) { return std::clamp(v / side_, 0, kSide - 1); };
    for (std::int32_t v = square(box.z0); v <= square(box.z1); ++v) {
      for (std::int32_t u = square(box.x0); u <= square(box.x1); ++u)
        visit(static_cast<std::size_t>(v * kSide + u));
    }
  }
  std::size_t words_ = 0;
  std::int32_t side_ = 1;
  std::vector<std::uint64_t> bits_;
};

struct Patch {
  int level = 0;
  Square square;  // the samples that the patch serves
  // The origin: the square's corner, rounded down to a point of the guide.
  std::int64_t x = 0, z = 0;
  float unit_m = 0;
  float sea_level_m = 0;
  float shore_m = 0;             // the ground rises by this over one share of lake
  std::vector<Spot> spots;       // rows of the lattice, then columns
  std::vector<Spot> lake_spots;  // copies of those that have a lake
  std::vector<Curve> curves;     // in the order of their nodes, then of directions
  std::vector<Lake> lakes;       // ascending by level, then body
  ReachBins spot_bins, curve_bins, lake_bins;

  // Call visit(spot) or visit(curve) for all that reach a box, in the order of their lists. Every
  // patch that covers the box has the same ones, in the same order.
  template <class Visit>
  void each_spot(const Box& box, const Visit& visit) const {
    spot_bins.find(box, [&](std::size_t k) {
      if (reaches(spots[k], box)) visit(spots[k]);
    });
  }
  template <class Visit>
  void each_curve(const Box& box, const Visit& visit) const {
    curve_bins.find(box, [&](std::size_t k) {
      if (reaches(curves[k], box)) visit(curves[k]);
    });
  }
  // False if no lake covers any place of a box: no spot of one reaches the points of the guide that
  // these places read.
  bool may_have_lake(const Box& box) const;
  // False if neither a lake nor a channel covers any place of a box.
  bool may_have_water(const Box& box) const;

  // True for the height of the surface of a lake. Channels run through lakes, at their level.
  bool is_lake_level(double surface_m, double tolerance_m = 0.02) const;

  // The reach of a spot or a curve in units, rounded up; and true if it reaches a box.
  static std::int32_t reach_units(const Spot& s) { return s.reach; }
  std::int32_t reach_units(const Curve& c) const {
    return static_cast<std::int32_t>(c.reach_m / unit_m) + 1;
  }
  template <class Thing>
  bool reaches(const Thing& thing, const Box& box) const {
    return box.grown(reach_units(thing)).holds(thing.x, thing.z);
  }
  // Metres between two places along an axis, in units.
  float metres(std::int32_t from, std::int32_t to) const {
    return static_cast<float>(to - from) * unit_m;
  }
  // Memory of the patch, with its lists.
  std::size_t bytes() const;

  // Used while a patch is made. Units of a node from the origin:
  std::int32_t x_of(const Node& n) const { return static_cast<std::int32_t>(n.x - x); }
  std::int32_t z_of(const Node& n) const { return static_cast<std::int32_t>(n.z - z); }
  // True if a disc touches the square, or guide points around it.
  bool is_reached(std::int32_t at_x, std::int32_t at_z, double reach) const;
  // Bins of spots or curves. Those beyond the square lie in the bins at its border.
  template <class Thing>
  ReachBins bins_of(const std::vector<Thing>& things) const {
    ReachBins bins(things.size(), static_cast<std::int32_t>(square.side / ReachBins::kSide) + 1);
    for (std::size_t k = 0; k < things.size(); ++k) {
      const std::int32_t at_x = things[k].x, at_z = things[k].z;
      bins.add(k, Box{at_x, at_z, at_x, at_z}.grown(reach_units(things[k])));
    }
    return bins;
  }
  // Ends the making of the patch.
  void fill_bins();
};

// The exact monotone map from heights of the network to heights of the world. Height 0 becomes the
// sea level, and all heights stay within the relief.
float height_m(const Scale& scale, std::int32_t height);
// Height of the water of a node in metres; the sea's over its floor.
inline float water_m(const Scale& scale, const Node& n) {
  return height_m(scale, std::max(n.height, 0));
}

// Mean height of the ground of the finest level above the nodes of a level, in units of height.
std::int32_t lift(const Scale& scale, int level, float mountain);

// The square of a patch, and how far beyond it nodes of a level shape its ground.
Surroundings surroundings_of(const Scale& scale, int level, const Square& square);
// Makes the patch of a square from the nodes of its level in surroundings_of().
Patch make_patch(const Scale& scale, const NodePatch& nodes, const Square& square);

}  // namespace psygen::models::network
