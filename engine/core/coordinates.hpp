// Positions in the world. A world position is a block (integers) and metres inside it, so precision
// does not depend on the distance from the origin. Metres; +Y is up; right-handed; block (x, z)
// spans local [0, size) on both axes. Not a transform hierarchy. Plain values; any thread.
#pragma once

#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/common.hpp>
#include <glm/ext/quaternion_float.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/core/hash.hpp"

namespace psygen::core {

// The libraries and the programs that use them must have the same layout of GLM's types. All public
// headers with such types include this one.
static_assert(alignof(glm::vec2) == 4 && alignof(glm::vec3) == 4 && alignof(glm::vec4) == 4 &&
                  sizeof(glm::vec3) == 12 && sizeof(glm::dvec3) == 24 &&
                  alignof(glm::dvec3) == alignof(double) && alignof(glm::mat4) == 4,
              "psygen needs GLM's packed vectors: compile without "
              "GLM_FORCE_DEFAULT_ALIGNED_GENTYPES");
static_assert(offsetof(glm::quat, x) == 0 && offsetof(glm::quat, w) == 12,
              "psygen needs quaternions in the order x, y, z, w: compile without "
              "GLM_FORCE_QUAT_DATA_WXYZ");

// A block of the ground, in blocks east (+X) and south (+Z) of block (0, 0). Both wrap at 2^32.
struct BlockCoord {
  std::int32_t x = 0;
  std::int32_t z = 0;
  friend constexpr auto operator<=>(const BlockCoord&, const BlockCoord&) = default;
};
static_assert(sizeof(BlockCoord) == 8);

// Axis-aligned box in metres, relative to a frame that its user defines.
struct Bounds {
  glm::vec3 min{0.0F};
  glm::vec3 max{0.0F};
  // Returns the box with this centre and these half extents (>= 0), in metres.
  static Bounds around(const glm::vec3& centre, const glm::vec3& half_extent) {
    return {centre - half_extent, centre + half_extent};
  }
  // Centre and half extents of the box, in metres.
  glm::vec3 centre() const { return (min + max) * 0.5F; }
  glm::vec3 half_extent() const { return (max - min) * 0.5F; }
  friend bool operator==(const Bounds&, const Bounds&) = default;
};

// The smallest box around two boxes.
inline Bounds united(const Bounds& a, const Bounds& b) {
  return {glm::min(a.min, b.min), glm::max(a.max, b.max)};
}

// True if all three components are finite.
inline bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
inline bool is_finite(const glm::vec3& v) {
  return is_finite(glm::dvec3(v));
}

// True if the corners are finite and no component of `min` exceeds that of `max`.
inline bool is_box(const Bounds& b) {
  return is_finite(b.min) && is_finite(b.max) && b.min.x <= b.max.x && b.min.y <= b.max.y &&
         b.min.z <= b.max.z;
}

// A position in the world. Normalised when local x and z lie in [0, block size).
struct WorldPosition {
  BlockCoord block;
  // Metres from the block's corner.
  glm::dvec3 local{0.0};
};

// Returns the block that lies this many blocks east and south of `block`. Indices wrap at 2^32.
constexpr BlockCoord moved(BlockCoord block, std::int64_t east, std::int64_t south) {
  const auto wrap = [](std::int32_t index, std::int64_t steps) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(index) +
                                     static_cast<std::uint32_t>(steps));
  };
  return {wrap(block.x, east), wrap(block.z, south)};
}

// Returns the same position with local x and z in [0, block_size_m). Block indices wrap at 2^32.
inline WorldPosition normalised(WorldPosition p, double block_size_m) {
  const double east = std::floor(p.local.x / block_size_m);
  const double south = std::floor(p.local.z / block_size_m);
  p.block = moved(p.block, static_cast<std::int64_t>(east), static_cast<std::int64_t>(south));
  p.local.x -= east * block_size_m;
  p.local.z -= south * block_size_m;
  return p;
}

// Metres from `origin` to the corner of `block`, at height 0. Exact up to 2^31 blocks apart.
inline glm::dvec3 offset_m(BlockCoord block, const WorldPosition& origin, double block_size_m) {
  const auto difference = [](std::int32_t a, std::int32_t b) {
    return static_cast<double>(
        static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b)));
  };
  return {difference(block.x, origin.block.x) * block_size_m - origin.local.x, -origin.local.y,
          difference(block.z, origin.block.z) * block_size_m - origin.local.z};
}

// Lets unordered containers use blocks as keys.
struct BlockCoordHash {
  // A bijective mix of both indices. O(1).
  std::size_t operator()(BlockCoord b) const {
    return static_cast<std::size_t>(mix64((std::uint64_t{static_cast<std::uint32_t>(b.x)} << 32) |
                                          static_cast<std::uint32_t>(b.z)));
  }
};

}  // namespace psygen::core
