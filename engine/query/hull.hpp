// The faces of the convex hull of a set of points, built one point at a time. For the few points of
// a collider: quadratic time. Pure, any thread.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace psygen::query {

// All p with dot(normal, p) <= distance. The normal has unit length and points outwards.
struct HalfSpace {
  glm::vec3 normal{0, 1, 0};
  float distance = 0;
};

// Returns the half-spaces whose intersection is the hull, up to 1e-5 of its extent. Empty for
// points in one plane, for fewer than four points, and for values that are not finite.
std::vector<HalfSpace> hull_faces(std::span<const glm::vec3> points);

}  // namespace psygen::query
