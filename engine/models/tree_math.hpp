// Small arithmetic that trees are made of: sine and cosine by polynomial, frames, random fractions
// of a hash. Only additions, multiplications, divisions and square roots, each rounded on its own,
// so that every machine computes the same bits. Not a general maths library.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

#include "engine/core/hash.hpp"

namespace psygen::models {

inline float dot3(const glm::vec3& a, const glm::vec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline glm::vec3 normalised3(const glm::vec3& v) {
  return v * (1.0F / std::sqrt(dot3(v, v) + 1e-20F));
}

// sin(2πx) for |x| < 64, absolute error below 3e-7.
inline float sin_turns(float x) {
  x -= static_cast<float>(static_cast<int>(x + 64.5F) - 64);        // [-1/2, 1/2]
  const float folded = std::min(std::max(x, -0.5F - x), 0.5F - x);  // [-1/4, 1/4], same sine
  const float y = folded * 6.28318530717958648F;
  const float z = y * y;
  return y * (1.0F + z * (-1.0F / 6 +
                          z * (1.0F / 120 +
                               z * (-1.0F / 5040 + z * (1.0F / 362880 - z * (1.0F / 39916800))))));
}
inline float cos_turns(float x) {
  return sin_turns(x + 0.25F);
}

// Unit vectors with u × v = d for the unit vector d, continuous wherever d.y
// keeps its sign (after Duff et al. 2017, with y for z).
struct Frame {
  glm::vec3 u, v;
};
inline Frame frame_around(const glm::vec3& d) {
  const float sign = d.y >= 0.0F ? 1.0F : -1.0F;
  const float a = -1.0F / (sign + d.y);
  const float b = d.z * d.x * a;
  return {{sign * b, -sign * d.z, 1.0F + sign * d.z * d.z * a}, {sign + d.x * d.x * a, -d.x, b}};
}

// Four fractions in [0, 1) with 16 bits each.
struct Fractions {
  float f[4];
  explicit Fractions(std::uint64_t hash) {
    for (int i = 0; i < 4; ++i)
      f[i] = static_cast<float>(static_cast<std::int32_t>((hash >> (16 * i)) & 0xFFFFU)) *
             (1.0F / 65536.0F);
  }
};

}  // namespace psygen::models
