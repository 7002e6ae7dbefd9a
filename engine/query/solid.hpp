// A collider prepared for rays: its shapes, their box, and the faces of hulls, which are computed
// when a ray first comes near. Positions are in metres from the model's base point. One thread.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "engine/models/collider.hpp"

namespace psygen::query {

// All p with dot(normal, p) <= distance. The normal has unit length and points outwards.
struct HalfSpace {
  glm::vec3 normal{0, 1, 0};
  float distance = 0;
};

// Returns the half-spaces whose intersection is the convex hull of the points, up to 1e-5 of its
// extent. Empty for points in one plane, for fewer than four points, and for values that are not
// finite. Built one point at a time, for the few points of a collider: quadratic time. Pure.
std::vector<HalfSpace> hull_faces(std::span<const glm::vec3> points);

// Intersection of a ray with a solid.
struct SolidHit {
  double t = 0;
  glm::vec3 normal{0, 1, 0};  // outwards; against the ray if it begins inside
  bool from_inside = false;
};

// The points origin + t · direction; the direction has unit length.
struct Line {
  glm::dvec3 origin{0.0}, direction{0.0};
};
// A line with the inverse of its direction, for many boxes.
struct BoxLine {
  glm::dvec3 origin{0.0}, inverse{0.0};
  // Directions along an axis also get finite inverses, so that products are not NaN.
  explicit BoxLine(const Line& line);
};

// Returns the first point where `line` enters a shape, for t in [0, longest]. A line that begins
// inside enters at 0. `faces` are the result of hull_faces(), for hulls.
std::optional<SolidHit> cast(const Line& line, double longest, const models::Collider::Shape& shape,
                             std::span<const HalfSpace> faces);
// Returns true if the line comes within 1 mm of a box.
bool meets(const BoxLine& line, double longest, const core::Bounds& box);

// One collider.
class Solid {
 public:
  // Skips shapes with values that are not finite, radii or extents that are not positive, and hulls
  // of fewer than four points. Rays pass through hulls without volume.
  explicit Solid(models::Collider collider);

  const models::Collider& collider() const { return collider_; }
  // The box around all shapes.
  const core::Bounds& box() const { return box_; }
  // Memory on the heap, with the hull faces that are not computed yet.
  std::size_t heap_bytes() const;
  // Returns the first point where `line` enters a shape. The first call takes some 10 µs for each
  // hull of 34 points.
  std::optional<SolidHit> cast(const Line& line, double longest);

 private:
  models::Collider collider_;
  std::vector<std::vector<HalfSpace>> faces_;  // of the hulls, in order, as far as computed
  core::Bounds box_;
};

}  // namespace psygen::query
