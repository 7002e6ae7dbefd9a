// Lines, triangles and infinite values, for tests of rays.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace psygen::query::testing {

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Returns the parameter where a line crosses a triangle (Möller and Trumbore), or a negative value.
// `slack` widens the triangle, relative to its size.
inline double crosses(const glm::dvec3& from, const glm::dvec3& d, const glm::dvec3& a,
                      const glm::dvec3& b, const glm::dvec3& c, double slack = 0) {
  const glm::dvec3 e1 = b - a, e2 = c - a, p = glm::cross(d, e2), s = from - a;
  const double det = glm::dot(e1, p);
  if (std::abs(det) < 1e-12) return -1;
  const glm::dvec3 q = glm::cross(s, e1);
  const double u = glm::dot(s, p) / det, v = glm::dot(d, q) / det;
  return u >= -slack && v >= -slack && u + v <= 1 + slack ? glm::dot(e2, q) / det : -1;
}

}  // namespace psygen::query::testing
