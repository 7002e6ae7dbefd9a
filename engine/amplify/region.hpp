// A rectangle of blocks, half-open: x0 … x1 − 1 by z0 … z1 − 1. Plain values and pure functions of
// constant time, any thread. It knows no meshes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "engine/core/coordinates.hpp"
#include "engine/core/error.hpp"
#include "engine/world/world.hpp"

namespace psygen::amplify {

// Coordinates in blocks.
struct Region {
  std::int64_t x0 = 0, z0 = 0, x1 = 0, z1 = 0;
  // Number of blocks inside. Sides have at most 2^32 blocks, so only the square of all blocks needs
  // more than 64 bits; then the result is 2^64 − 1.
  std::uint64_t block_count() const;
  // The i-th block, row by row (z outer, x inner). Requires i < block_count().
  core::BlockCoord block(std::uint64_t i) const;
  // The index of a block; nothing outside.
  std::optional<std::uint64_t> number_of(core::BlockCoord block) const;
  friend bool operator==(const Region&, const Region&) = default;
};

// Parses "X0,Z0,X1,Z1". Fails with kInvalidArgument for anything else, for empty regions, and for
// blocks outside −2^31 … 2^31 − 1.
core::Result<Region> parse_region(std::string_view text);

// Such a text.
std::string text_of(const Region& region);

// The region of a whole world. Fails with kInvalidArgument for endless worlds.
core::Result<Region> whole(const world::World& world);

// Fails with kInvalidArgument if part of `region` is outside the world. The message names the
// existing blocks.
core::Result<void> check_region(const world::World& world, const Region& region);

}  // namespace psygen::amplify
