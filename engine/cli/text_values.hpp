// Parses values of the command line, and finds places as users write them. Pure.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <string>

#include "engine/core/coordinates.hpp"
#include "engine/core/error.hpp"
#include "engine/core/surface_provider.hpp"
#include "engine/world/world.hpp"

namespace psygen::cli {

// A number of bytes: digits with an optional suffix K, M, G or T (powers of 1024), also written
// "MiB" and so on.
core::Result<std::uint64_t> parse_bytes(const std::string& text);

// Pixels as WIDTHxHEIGHT, each 1 … 16384.
core::Result<core::Extent> parse_size(const std::string& text);

// A position as X,Z: two finite numbers, in metres from the corner of block (0, 0).
core::Result<glm::dvec2> parse_place(const std::string& text);
// Converts it to a world position at height 0. Fails with kInvalidArgument outside the world.
core::Result<core::WorldPosition> position_at(const world::World& world, glm::dvec2 place);

// A block as X,Z: two integers of 32 bits.
core::Result<core::BlockCoord> parse_block(const std::string& text);

}  // namespace psygen::cli
