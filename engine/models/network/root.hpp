// The coarsest nodes of a river network: a forest of cheapest paths to the sea or to an inland
// lake. A tile of the forest is exact although it is found in a bounded window: a border of p nodes
// proves every node whose path costs less than any path from outside could, and grows until all
// nodes are proved. Inland lakes bound it by 434 nodes. Source of the idea: Maritan et al. (1996),
// "Universality classes of optimal channel networks". Pure functions; any thread.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <unordered_map>

#include "engine/models/network/lattice.hpp"

namespace psygen::models::network {

// A node's step on the cheapest path.
struct Way {
  std::uint8_t receiver = kSink;
  bool sea = false;
};

// Names a square tile of root nodes or of ground.
struct TileKey {
  int level = 0;
  std::int64_t i = 0, j = 0;
  friend bool operator==(const TileKey&, const TileKey&) = default;
};
struct TileKeyHash {
  std::size_t operator()(const TileKey& key) const {
    return static_cast<std::size_t>(core::combine(
        core::combine(static_cast<std::uint64_t>(key.level), static_cast<std::uint64_t>(key.i)),
        static_cast<std::uint64_t>(key.j)));
  }
};

// kSide² nodes of the root, from (kSide · i, kSide · j) on.
struct RootTile {
  static constexpr std::int64_t kSide = 32;
  std::array<Way, kSide * kSide> ways;
  std::size_t bytes() const { return sizeof(RootTile); }
};

// Slow fields of the land: continents and mountains. Remembers the last lattice square of each
// octave; one thread at a time.
class LandFields {
 public:
  explicit LandFields(const Scale& scale);
  double continent(std::int64_t x, std::int64_t z);  // > 0 on land
  double mountains(std::int64_t x, std::int64_t z);  // 0 … 1

 private:
  // Value-gradient noise, about −1 … 1.
  struct Octave {
    std::int64_t cell = 1;  // units
    std::uint64_t key = 0;
    double amplitude = 1;
    bool valid = false;
    std::int64_t i = 0, j = 0;
    struct Corner {
      double gx = 0, gz = 0, value = 0;
    };
    std::array<Corner, 4> corners;
    double at(std::int64_t x, std::int64_t z);
  };
  std::array<Octave, 3> land_;
  std::array<Octave, 2> high_;
  double land_offset_ = 0, high_offset_ = 0;
};

// Finds a tile; about 2 ms. `border` is the first width tried and changes no bit.
RootTile make_root_tile(const Scale& scale, const TileKey& key, std::int64_t border = 40);

// The nodes of the root with areas and heights, found along the rivers. Remembers them; one thread
// at a time.
class RootNodes {
 public:
  using TileSource = std::function<std::shared_ptr<const RootTile>(const TileKey&)>;
  RootNodes(const Scale& scale, TileSource tiles);

  // A node; the reference stays valid. Calls nest as deep as a path is long: 434 nodes at most, 30
  // usually.
  const Node& node(std::int64_t i, std::int64_t j);
  LandFields& fields() { return fields_; }

 private:
  const Way& way(std::int64_t i, std::int64_t j);
  std::uint32_t area(std::int64_t i, std::int64_t j);

  const Scale& scale_;
  TileSource source_;
  LandFields fields_;
  std::unordered_map<TileKey, std::shared_ptr<const RootTile>, TileKeyHash> tiles_;
  TileKey last_{-1, 0, 0};
  const RootTile* last_tile_ = nullptr;
  std::unordered_map<TileKey, std::uint32_t, TileKeyHash> areas_;
  std::unordered_map<TileKey, Node, TileKeyHash> nodes_;
};

}  // namespace psygen::models::network
