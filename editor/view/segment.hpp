// The distance of a point from a line between two points, in the plane. Pure.
#pragma once

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace psygen::editor {

// Of glm::vec2 or glm::dvec2; where both ends are one point, that from it.
template <class Vec>
typename Vec::value_type distance_to_segment(const Vec& p, const Vec& a, const Vec& b) {
  using T = typename Vec::value_type;
  const Vec along = b - a;
  const T length2 = glm::dot(along, along);
  const T t = length2 > 0 ? glm::clamp(glm::dot(p - a, along) / length2, T(0), T(1)) : T(0);
  return glm::length(p - (a + t * along));
}

}  // namespace psygen::editor
