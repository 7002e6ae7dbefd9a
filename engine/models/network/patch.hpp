// What the ground of one square tile needs of a river network: the nodes with the radii of their
// kernels, the channels as curves, and the lakes. A patch is a function of its key alone, complete
// before anybody reads it, and immutable after: any thread may read it. Several patches that cover
// a point give it the same bits, because every spot and curve is cut by its own distance.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <compare>
#include <cstdint>
#include <memory>
#include <vector>

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

// A channel from the middle of an inflow towards (not through) its node to the middle of the
// outflow: a quadratic Bézier curve whose heights are blended alike, so they never rise.
//
// Water that touches other water neither rises nor has a step:
// - Arms of one node end at one height. From where two of them touch, both have that height.
// - A channel that runs into a wider and lower one ends there, and falls to its height before.
// - Other water that overlaps is blended (kernel.cpp), so that each middle keeps its own height.
struct Curve {
  static constexpr std::size_t kChords = 6;
  std::int32_t x = 0, z = 0;       // of its node, units from the patch's origin
  std::uint32_t chords = kChords;  // in use; fewer if the channel ends in a wider one
  // Metres from the node.
  std::array<float, kChords + 1> px{}, pz{};
  std::array<float, kChords> inverse_length2{};  // 1/m²; 0: the chord has no length
  std::array<float, 3> height_m{};               // of the water, never rising
  float min_m = -1e30F;                          // the water is no lower
  std::array<float, 4> turn{};  // direction x, z at the beginning and at the end, not normalised
  float width0_m = 0, width1_m = 0;
  float discharge_m3_s = 0;
  float reach_m = 0;  // no point farther from the node changes
  std::uint32_t body = 0;
  bool head = false;  // a spring: the bed begins here
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
  float shore_m = 0;                      // the ground rises by this over one share of lake
  std::vector<Spot> spots;                // rows of the lattice, then columns
  std::vector<std::uint32_t> lake_spots;  // indices of those that have a lake, ascending
  std::vector<Curve> curves;              // in the order of their nodes, then of directions
  std::vector<Lake> lakes;                // ascending by level, then body
  ReachBins spot_bins, curve_bins;

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

  // The reach of a spot or a curve in units, rounded up; and true if it reaches a box.
  static std::int32_t reach_units(const Spot& s) { return s.reach; }
  std::int32_t reach_units(const Curve& c) const {
    return static_cast<std::int32_t>(c.reach_m / unit_m) + 1;
  }
  template <class Thing>
  bool reaches(const Thing& thing, const Box& box) const {
    return box.grown(reach_units(thing)).holds(thing.x, thing.z);
  }
  // Memory of the patch, with its lists.
  std::size_t bytes() const;
};

// Mean discharge of a river with this drainage area, in m³/s: 20 litres a second from a km², about
// 630 mm of rain a year that does not evaporate. The speed of channels follows from it.
constexpr double kRunoffM3_SKm2 = 0.02;
constexpr double discharge_m3_s(double km2) {
  return kRunoffM3_SKm2 * km2;
}
// Water as wide as a river with this drainage area, at most `max_m`.
float channel_width_m(double km2, double max_m);
// Depth of the middle of a channel, in metres and in widths.
constexpr float kBedM = 0.25F, kBedWidths = 0.07F;
constexpr float channel_depth_m(float width_m) {
  return kBedM + kBedWidths * width_m;
}
// Speed in the middle of a channel, in m/s, at most kFastestM_S. Depth and speed are parabolas
// across, so it is 1.25 times the discharge over the cross-section.
constexpr float kMiddleSpeed = 1.25F / (2.0F / 3.0F), kFastestM_S = 6;
constexpr float middle_speed_m_s(float discharge_m3_s, float width_m) {
  return std::min(kMiddleSpeed * discharge_m3_s / (width_m * channel_depth_m(width_m)),
                  kFastestM_S);
}
// Height and width of the water of a curve, in metres; t: its parameter, 0 … 1.
float level_m(const Curve& c, float t);
constexpr float width_m(const Curve& c, float t) {
  return c.width0_m + t * (c.width1_m - c.width0_m);
}
// The place of a curve that is nearest to a point, which is in metres from the curve's node.
struct NearestPlace {
  float distance_m = 0, t = 0;
};
NearestPlace nearest_place(const Curve& c, float x_m, float z_m);
// Width of the ground beside a channel that the channel lowers, and that it may raise.
constexpr float kValleyM = 36, kLeveeM = 12, kBankWidths = 1.5F;
// Beside the water's edge the lowered ground rises by the bank within a metre, and by this slope.
constexpr float kBankRiseM = 0.3F, kValleySlope = 0.12F;
constexpr float bank_m(float width_m) {
  return kValleyM + kBankWidths * width_m;
}

// The exact monotone map from heights of the network to heights of the world. Height 0 becomes the
// sea level, and all heights stay within the relief.
float height_m(const Scale& scale, std::int32_t height);

// Mean height of the ground of the finest level above the nodes of a level, in units of height.
std::int32_t lift(const Scale& scale, int level, float mountain);

// The square of a patch, and how far beyond it nodes of a level shape its ground.
Surroundings surroundings_of(const Scale& scale, int level, const Square& square);
// Makes the patch of a square from the nodes of its level in surroundings_of().
Patch make_patch(const Scale& scale, const NodePatch& nodes, const Square& square);

}  // namespace psygen::models::network
