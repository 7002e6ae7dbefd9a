// Packs numbers into the bytes of a vertex (engine/core/vertex_layout.hpp): snorm and unorm rounded
// to nearest, octahedral normals, colours stored as square roots. Same bits on every CPU: only
// additions, multiplications, divisions and square roots. Pure, any thread, constant time. Not a
// general pixel-format library.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "engine/core/coordinates.hpp"
#include "engine/core/vertex_layout.hpp"

namespace psygen::models {

// Nearest integer to `v`, halves to even. Requires |v| < 2^22. Adding 1.5 · 2^23 leaves a float
// whose lowest bit is worth 1.
inline std::int32_t round_to_int(float v) {
  return std::bit_cast<std::int32_t>(v + 12582912.0F) - std::bit_cast<std::int32_t>(12582912.0F);
}

// Pack [-1, 1] as snorm16 (±32767), or [0, 1] as unorm8. Values outside the range are clamped.
inline std::int16_t pack_snorm16(float v) {
  return static_cast<std::int16_t>(round_to_int(std::clamp(v, -1.0F, 1.0F) * 32767.0F));
}
inline std::uint8_t pack_unorm8(float v) {
  return static_cast<std::uint8_t>(round_to_int(std::clamp(v, 0.0F, 1.0F) * 255.0F));
}
// Albedo in [0, 1], linear light, stored as its square root: albedo = (byte / 255)².
inline std::uint8_t pack_albedo(float albedo) {
  return pack_unorm8(std::sqrt(std::max(albedo, 0.0F)));
}

// Octahedral mapping about +Y, to [-1, 1]². Let e = (x, z) / (|x| + |y| + |z|). Directions with
// y >= 0 fill the diamond |e.x| + |e.y| <= 1; those with y < 0 are folded outwards into the corners
// of the square. `n` may have any length except zero.
inline glm::vec2 encode_octahedral(const glm::vec3& n) {
  const float scale = 1.0F / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
  const float x = n.x * scale, z = n.z * scale;
  const float folded_x = (1.0F - std::abs(z)) * (x >= 0.0F ? 1.0F : -1.0F);
  const float folded_z = (1.0F - std::abs(x)) * (z >= 0.0F ? 1.0F : -1.0F);
  const bool above = n.y >= 0.0F;
  return {above ? x : folded_x, above ? z : folded_z};
}
// The unit vector of a pair from encode_octahedral(). The shaders compute the same.
inline glm::vec3 decode_octahedral(glm::vec2 e) {
  glm::vec3 n{e.x, 1.0F - std::abs(e.x) - std::abs(e.y), e.y};
  const float fold = std::max(-n.y, 0.0F);
  n.x += n.x >= 0.0F ? -fold : fold;
  n.z += n.z >= 0.0F ? -fold : fold;
  return n * (1.0F / std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z));
}

// Packs points of one box as snorm16: p = centre + half_extent · packed / 32767.
class BoxPacker {
 public:
  // Along an axis where `box` has no extent, every point packs to 0.
  explicit BoxPacker(const core::Bounds& box) : centre_(box.centre()) {
    const glm::vec3 half = box.half_extent();
    scale_ = {half.x > 0 ? 1 / half.x : 0, half.y > 0 ? 1 / half.y : 0,
              half.z > 0 ? 1 / half.z : 0};
  }
  // Points outside the box are clamped to its faces.
  void pack(const glm::vec3& p, std::int16_t (&out)[3]) const {
    out[0] = pack_snorm16((p.x - centre_.x) * scale_.x);
    out[1] = pack_snorm16((p.y - centre_.y) * scale_.y);
    out[2] = pack_snorm16((p.z - centre_.z) * scale_.z);
  }

 private:
  glm::vec3 centre_;
  glm::vec3 scale_;
};

// The position of a vertex in metres. `box` is the one that it was packed in.
inline glm::vec3 unpack_position(const core::ModelVertex& v, const core::Bounds& box) {
  return box.centre() +
         box.half_extent() *
             (glm::vec3(v.position[0], v.position[1], v.position[2]) * (1.0F / 32767.0F));
}

}  // namespace psygen::models
