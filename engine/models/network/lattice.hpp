// The triangular lattice that a river network grows on. Node (i, j) of level k + 1 with two even
// indices is node (i/2, j/2) of level k; each other one is the middle of exactly one edge of level
// k. Positions are whole units of 1/64 cell, heights of 1/1024 m, areas count nodes of the finest
// level, so sums have no order. Plain values and pure functions; any thread.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/models/network/settings.hpp"

namespace psygen::models::network {

constexpr std::int64_t kUnitsPerCell = 64;
constexpr double kHeightUnits = 1024;  // units of height in a metre

// The six directions from a node. Opposite ones differ by 3.
constexpr std::array<int, 6> kStepI{1, 0, -1, -1, 0, 1};
constexpr std::array<int, 6> kStepJ{0, 1, 1, 0, -1, -1};
constexpr int opposite(int direction) {
  return (direction + 3) % 6;
}
// The direction of a node without a receiver.
constexpr std::uint8_t kSink = 6;

// Division that rounds down. Requires b > 0.
constexpr std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a / b - static_cast<std::int64_t>(a % b < 0);
}

// A rectangle of nodes, half open.
struct Rect {
  std::int64_t i0 = 0, j0 = 0, i1 = 0, j1 = 0;
  constexpr Rect grown(std::int64_t by) const { return {i0 - by, j0 - by, i1 + by, j1 + by}; }
  constexpr std::int64_t width() const { return i1 - i0; }
  constexpr std::int64_t height() const { return j1 - j0; }
  constexpr bool holds(const Rect& r) const {
    return r.i0 >= i0 && r.j0 >= j0 && r.i1 <= i1 && r.j1 <= j1;
  }
  friend constexpr bool operator==(const Rect&, const Rect&) = default;
};

// Names of bodies of water: that of the sea, and those of lakes by random bits.
constexpr std::uint32_t kSeaBody = 1;
constexpr std::uint32_t lake_name(std::uint64_t bits) {
  return std::max(static_cast<std::uint32_t>(bits) | 1U, kSeaBody + 2);
}

enum class Kind : std::uint8_t { kLand, kSea, kLake };
// A source is a node that lay off the rivers when it was made. The first kind may take in the
// second, so chains of new sources have two links at most.
enum class Source : std::uint8_t { kNone, kGathering, kPlain };

struct Node {
  std::int64_t x = 0, z = 0;      // units
  std::int32_t height = 0;        // of the stream, the lake, or the sea's floor (< 0)
  std::int32_t depth = 0;         // of a lake
  std::uint32_t area = 0;         // that drains through the node, itself included
  std::uint32_t lake = 0;         // names the lake; 0 off lakes
  float mountain = 0;             // 0 plains … 1 mountains
  std::uint8_t receiver = kSink;  // direction of the node that it drains to
  Kind kind = Kind::kLand;
  std::uint8_t made = 0;         // level that made it
  Source fresh = Source::kNone;  // at the level that made it only
  bool river = false;            // lay on a river when it was made
  bool sill = false;             // fills the lower parts of the edges that run into it
};

// Distances, factors and hash keys of one network.
struct Scale {
  RiverSettings settings;
  RiverFrame frame;
  std::int64_t spacing0 = 0;  // of the root, units; the finest spacing is a whole number of cells
  double unit_m = 0;          // metres of a unit
  double node_km2 = 0;        // area of a node of the finest level
  double size = 0;            // of the root over 8192 m: factor of heights fixed in metres
  std::uint32_t channel_area = 0;        // nodes from which on a stream has a bed
  std::array<std::uint64_t, 16> keys{};  // of each level's hashes
  std::array<double, 9> rise{};          // of a middle above the higher end, over the edge's length
  std::array<double, 9> lakes{};         // fraction of river nodes that are sills, by level

  // Requires what check() accepts.
  Scale(const RiverSettings& settings, const RiverFrame& frame);

  int halvings() const { return settings.halvings; }
  std::int64_t spacing(int level) const { return spacing0 >> level; }
  double km2(double area) const { return area * node_km2; }
  // Random bits of node (i, j). Mix them with small numbers for more.
  std::uint64_t hash(int level, std::int64_t i, std::int64_t j) const {
    const std::uint64_t row =
        core::mix64(keys[static_cast<std::size_t>(level)] ^ static_cast<std::uint64_t>(i));
    return core::mix64(row + static_cast<std::uint64_t>(j));
  }
};

// Two numbers in [0, 1) from 64 random bits.
struct Pair {
  double first, second;
};
constexpr Pair pair_of(std::uint64_t bits) {
  return {static_cast<double>(bits >> 32) * 0x1p-32,
          static_cast<double>(bits & 0xFFFFFFFF) * 0x1p-32};
}

// Length of a vector. The square root rounds correctly everywhere, which std::hypot need not.
inline double length(double x, double z) {
  return std::sqrt(x * x + z * z);
}
// In units.
inline double distance(const Node& a, const Node& b) {
  return length(static_cast<double>(a.x - b.x), static_cast<double>(a.z - b.z));
}

// The nodes of a rectangle of one level.
struct NodePatch {
  int level = 0;
  Rect rect;
  std::vector<Node> nodes;  // rows of ascending j

  NodePatch(int of_level, const Rect& r)
      : level(of_level), rect(r), nodes(static_cast<std::size_t>(r.width() * r.height())) {}
  Node& at(std::int64_t i, std::int64_t j) { return nodes[index(i, j)]; }
  const Node& at(std::int64_t i, std::int64_t j) const { return nodes[index(i, j)]; }
  std::size_t bytes() const { return sizeof *this + nodes.capacity() * sizeof(Node); }
  // The neighbour of (i, j) in a direction.
  const Node& beside(std::int64_t i, std::int64_t j, int direction) const {
    const auto d = static_cast<std::size_t>(direction);
    return at(i + kStepI[d], j + kStepJ[d]);
  }

 private:
  std::size_t index(std::int64_t i, std::int64_t j) const {
    return static_cast<std::size_t>((j - rect.j0) * rect.width() + i - rect.i0);
  }
};

}  // namespace psygen::models::network
