// A rectangle of blocks, half-open: x0 … x1 − 1 by z0 … z1 − 1. Values; any thread.
#pragma once

#include <cstdint>
#include <string_view>

#include "engine/core/coordinates.hpp"
#include "engine/core/error.hpp"
#include "engine/world/world.hpp"

namespace psygen::amplify {

struct Region {
  std::int64_t x0 = 0, z0 = 0, x1 = 0, z1 = 0;
  // Blocks inside. Both sides are at most 2^32, so that only the square of all blocks needs more
  // than 64 bits: then it is 2^64 − 1.
  std::uint64_t block_count() const;
  // The i-th block, row by row (z outer, x inner). Requires i < block_count().
  core::BlockCoord block(std::uint64_t i) const;
  friend bool operator==(const Region&, const Region&) = default;
};

// "X0,Z0,X1,Z1". Fails with kInvalidArgument for anything else, and for a region that is empty or
// reaches beyond the blocks that there can be (−2^31 … 2^31 − 1).
core::Result<Region> parse_region(std::string_view text);

// All of a world. Fails with kInvalidArgument for an endless one.
core::Result<Region> whole(const world::World& world);

// Fails with kInvalidArgument, naming the blocks that exist, where part of `region` is outside.
core::Result<void> check_region(const world::World& world, const Region& region);

}  // namespace psygen::amplify
