// The solid parts of a model as simple shapes, for rays and physics. Values in metres from the
// model's base point; no behaviour beyond their bounds. Not the mesh: leaves and grass have no
// collider. Any thread.
#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <variant>
#include <vector>

#include "engine/core/coordinates.hpp"

namespace psygen::models {

// The union of some shapes. A model without shapes stops nothing.
struct Collider {
  // All points within `radius` >= 0 of `centre`.
  struct Sphere {
    glm::vec3 centre{0.0F};
    float radius = 0;
  };
  // All points within `radius` >= 0 of the line from `from` to `to`.
  struct Capsule {
    glm::vec3 from{0.0F}, to{0.0F};
    float radius = 0;
  };
  using Box = core::Bounds;
  // The convex hull of at least four points that do not lie in one plane.
  struct Hull {
    std::vector<glm::vec3> points;
  };
  using Shape = std::variant<Sphere, Capsule, Box, Hull>;

  std::vector<Shape> shapes;
  // True without shapes: the collider stops nothing.
  bool empty() const { return shapes.empty(); }
};

// Returns the bounds of one shape. Linear in its points.
inline core::Bounds bounds_of(const Collider::Shape& shape) {
  struct Visitor {
    core::Bounds operator()(const Collider::Sphere& s) const {
      return {s.centre - s.radius, s.centre + s.radius};
    }
    core::Bounds operator()(const Collider::Capsule& c) const {
      return {glm::min(c.from, c.to) - c.radius, glm::max(c.from, c.to) + c.radius};
    }
    core::Bounds operator()(const Collider::Box& b) const { return b; }
    core::Bounds operator()(const Collider::Hull& h) const {
      core::Bounds box{h.points.front(), h.points.front()};
      for (const glm::vec3& p : h.points)
        box = {glm::min(box.min, p), glm::max(box.max, p)};
      return box;
    }
  };
  return std::visit(Visitor{}, shape);
}

}  // namespace psygen::models
