// The settings of a river network, and the frame of the world that it lies in. Plain values; any
// thread. A network is a pure function of both.
#pragma once

#include <cstdint>

#include "engine/core/error.hpp"

namespace psygen::models {

// The shape of a network. Everything but `channel_km2` scales with `root_spacing_m`.
struct RiverSettings {
  // Names the rules of the network. A change of any rule that moves a bit raises it.
  static constexpr std::uint64_t kEdition = 3;
  // Names the random numbers, and so the courses of rivers and the heights of nodes.
  static constexpr std::uint64_t kRandomEdition = 1;

  std::uint64_t seed = 1;
  double root_spacing_m = 8192;  // between the largest nodes, 256 … 65536; relief ≈ a quarter of it
  int halvings = 7;              // of the root's edges, 1 … 8
  double channel_km2 = 0.08;    // drainage area at which a stream gets a bed, 1e-4 … 1000
  double lake_share = 0.04;     // fraction of the land under lakes, about; 0 … 0.12
  double mountain_share = 0.5;  // fraction of mountains, about; 0 … 1
  double sea_share = 0.35;      // fraction of sea, about; 0 … 1
  double steepness = 1;         // factor of all slopes, 0.05 … 3
  friend bool operator==(const RiverSettings&, const RiverSettings&) = default;
};

// The cells and heights of the world around the network.
struct RiverFrame {
  double cell_m = 1;                  // between vertices of node level 0, > 0
  std::int64_t cells_per_block = 63;  // 1 … 4096
  double relief_m = 1000;             // ground lies in [0, relief_m]
  double sea_level_m = 60;            // 0 < sea level < relief_m
  friend bool operator==(const RiverFrame&, const RiverFrame&) = default;
};

// Returns kInvalidArgument and the first value out of range, with its field and its range. The
// finest nodes must be 16 to 512 cells apart.
core::Result<void> check(const RiverSettings& settings, const RiverFrame& frame);

// A hash of the edition and all values, never 0.
std::uint64_t identity(const RiverSettings& settings, const RiverFrame& frame);

}  // namespace psygen::models
