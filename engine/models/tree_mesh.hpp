// From a tree's skeleton to packed vertices: the plan of each level of detail, the crown that all
// levels share, bark (tree_bark.cpp) and foliage (tree_foliage.cpp). Everything writes through one
// MeshWriter into memory of exactly the size that the plan predicts.
#pragma once

#include <cstring>
#include <span>

#include "engine/core/coordinates.hpp"
#include "engine/core/vertex_layout.hpp"
#include "engine/models/packing.hpp"
#include "engine/models/tree_math.hpp"
#include "engine/models/tree_skeleton.hpp"

namespace psygen::models {

inline constexpr int kTreeLevels = 6;
// Paths that give the crown its place and extent, and the foliage of level 3.
inline constexpr std::uint32_t kCrownPaths = 18;

// Packs attributes and appends to the destination. Positions are relative to `box` and clamped to
// it. The destination may be mapped device memory: it is written once, in order, and not read.
class MeshWriter {
 public:
  MeshWriter(const core::Bounds& box, const MeshView& out);

  std::uint32_t vertex_count() const { return vertex_count_; }
  std::uint32_t index_count() const { return index_count_; }

  struct Look {
    std::uint8_t ambient, sway;
    std::array<std::int16_t, 2> normal;
    std::array<std::uint8_t, 3> colour;
    std::uint8_t material;
  };
  void vertex(const glm::vec3& position, const Look& look) {
    core::ModelVertex v;
    for (int axis = 0; axis < 3; ++axis) {
      const float snorm = (position[axis] - center_[axis]) * scale_[axis];
      const float clamped = std::min(std::max(snorm, -32767.0F), 32767.0F);
      const std::int16_t q = rounded(clamped);
      v.position[axis] = q;
      low_[axis] = std::min(low_[axis], q);
      high_[axis] = std::max(high_[axis], q);
    }
    v.ambient = look.ambient;
    v.sway = look.sway;
    std::memcpy(v.normal, look.normal.data(), sizeof v.normal);
    std::memcpy(v.colour, look.colour.data(), sizeof v.colour);
    v.material = look.material;
    std::memcpy(vertices_ + std::size_t{vertex_count_} * sizeof v, &v, sizeof v);
    ++vertex_count_;
  }
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    std::uint16_t* to = indices_ + index_count_;
    to[0] = static_cast<std::uint16_t>(a);
    to[1] = static_cast<std::uint16_t>(b);
    to[2] = static_cast<std::uint16_t>(c);
    index_count_ += 3;
  }
  // Room for vertices and indices that the caller writes, each byte once; see include().
  std::byte* append_vertices(std::uint32_t count) {
    std::byte* first = vertices_ + std::size_t{vertex_count_} * sizeof(core::ModelVertex);
    vertex_count_ += count;
    return first;
  }
  std::uint16_t* append_indices(std::uint32_t count) {
    std::uint16_t* first = indices_ + index_count_;
    index_count_ += count;
    return first;
  }
  // Widens written() by positions in packed units, not yet rounded, in [-32767, 32767].
  void include(int axis, float low, float high) {
    low_[axis] = std::min(low_[axis], rounded(low));
    high_[axis] = std::max(high_[axis], rounded(high));
  }
  // Packed position = (position - box_center()) · box_scale(), then clamped and rounded.
  const glm::vec3& box_center() const { return center_; }
  const glm::vec3& box_scale() const { return scale_; }
  // The box of all vertices written, as a reader will unpack them.
  core::Bounds written() const;

 private:
  // Halves upwards; v in [-32767, 32767].
  static std::int16_t rounded(float v) {
    return static_cast<std::int16_t>(static_cast<int>(v + 32768.5F) - 32768);
  }

  glm::vec3 center_, scale_, half_;
  std::int16_t low_[3] = {32767, 32767, 32767}, high_[3] = {-32767, -32767, -32767};
  std::byte* vertices_;
  std::uint16_t* indices_;
  std::uint32_t vertex_count_ = 0, index_count_ = 0;
};

// Octahedral snorm16 pair of a direction, as vertex_layout.hpp defines it.
inline std::array<std::int16_t, 2> pack_normal(const glm::vec3& n) {
  const glm::vec2 e = encode_octahedral(n);
  return {pack_snorm16(e.x), pack_snorm16(e.y)};
}

// The tree's foliage as a whole: an ellipsoid about the tips of kCrownPaths paths.
struct TreeCrown {
  glm::vec3 center;
  glm::vec3 half;  // half axes in metres; x and z are equal
  glm::vec3 inverse_half;
  float radius;  // their mean
  // Position relative to the ellipsoid: length 1 on its surface.
  glm::vec3 relative(const glm::vec3& p) const { return (p - center) * inverse_half; }
};
// `sample` holds the paths grown with kCrownPaths.
TreeCrown crown_of(const TreeShape& shape, const TreeSkeleton& sample);

// Sides and segments of the tube of a branch at a depth; 0 sides: not drawn. A tip ends in one
// vertex.
struct TubePlan {
  std::uint32_t sides = 0, segments = 0;
  bool pointed = false;
  std::uint32_t vertices() const {
    return sides == 0 ? 0 : sides * segments + (pointed ? 1 : sides);
  }
  std::uint32_t triangles() const { return sides * 2 * segments - (pointed ? sides : 0); }
};
TubePlan tube_plan(int level, int depth, bool tip);

// Leaf sprays of levels 0 … 3 for a tree with so many tips (levels 2 and 3 do not ask).
std::uint32_t spray_count(int level, std::uint32_t tips);
inline constexpr std::uint32_t kSprayVertices = 6, kSprayTriangles = 4;
// Levels 4 and 5: the crown as one closed, bumpy hull.
inline constexpr std::uint32_t kBallVertices = 12, kBallTriangles = 20;
inline constexpr std::uint32_t kOctahedronVertices = 6, kOctahedronTriangles = 8;

// Baked ambient visibility in or below the crown, in [0, 1], from a position relative to it.
inline float ambient_of(float x, float y, float z) {
  const float out = std::min(std::sqrt(x * x + y * y + z * z), 1.2F) * (1.0F / 1.2F);
  const float height = std::min(std::max(0.5F + 0.5F * y, 0.0F), 1.0F);
  return (0.3F + 0.7F * out * out) * (0.6F + 0.4F * height);
}
inline float crown_ambient(const TreeCrown& crown, const glm::vec3& p) {
  const glm::vec3 r = crown.relative(p);
  return ambient_of(r.x, r.y, r.z);
}

// Stored (square root) leaf colour over the hue: deep green, green, yellow, orange, red.
std::array<float, 3> leaf_colour(float hue);
// Hue and brightness of a whole tree, about which its leaves vary.
struct LeafTint {
  float hue, brightness;
};
LeafTint leaf_tint(const TreeShape& shape);

void mesh_bark(const TreeShape& shape, int level, const TreeSkeleton& skeleton,
               const TreeCrown& crown, MeshWriter& out);
// Cones of 4 vertices and 3 triangles into the crown: from the trunk's end where the branches in
// between are left out (levels 2 and 3), from the foot (levels 4 and 5).
inline constexpr std::uint32_t kConeVertices = 4, kConeTriangles = 3;
void mesh_core(const TreeShape& shape, const TreeSkeleton& skeleton, const TreeCrown& crown,
               MeshWriter& out);
void mesh_far_trunk(const TreeShape& shape, const TreeCrown& crown, MeshWriter& out);

// `sprays` sprays shared out evenly over the skeleton's tips.
void mesh_sprays(const TreeShape& shape, int level, const TreeSkeleton& skeleton,
                 const TreeCrown& crown, std::uint32_t sprays, MeshWriter& out);
void mesh_hull(const TreeShape& shape, int level, const TreeCrown& crown, MeshWriter& out);

// Metres that the trunk reaches below the foot, so that it meets sloping ground.
inline float sink_m(const TreeShape& shape) {
  return 2.0F * shape.radius_m;
}

}  // namespace psygen::models
