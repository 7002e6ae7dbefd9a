#include "engine/query/solid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <utility>

namespace psygen::query {
namespace {

using Hit = std::optional<SolidHit>;
using models::Collider;

Hit begins_inside(const Line& line) {
  return SolidHit{0, glm::vec3(-line.direction), true};
}

// Returns the nearer of two hits.
Hit first_of(const Hit& a, const Hit& b) {
  return !b || (a && a->t <= b->t) ? a : b;
}

Hit cast_sphere(const Line& line, double longest, const glm::dvec3& centre, double radius) {
  const glm::dvec3 from = line.origin - centre;
  const double b = glm::dot(from, line.direction), c = glm::dot(from, from) - radius * radius;
  if (c <= 0) return begins_inside(line);
  const double root = b * b - c;
  if (b > 0 || root < 0) return std::nullopt;
  const double t = -b - std::sqrt(root);
  if (t > longest) return std::nullopt;
  return SolidHit{t, glm::vec3((from + t * line.direction) / radius), false};
}

Hit cast_capsule(const Line& line, double longest, const Collider::Capsule& capsule) {
  const glm::dvec3 foot(capsule.from), axis = glm::dvec3(capsule.to) - foot;
  const double radius = static_cast<double>(capsule.radius), length2 = glm::dot(axis, axis);
  Hit ends = cast_sphere(line, longest, foot, radius);
  if (length2 == 0) return ends;
  ends = first_of(ends, cast_sphere(line, longest, glm::dvec3(capsule.to), radius));
  if (ends && ends->from_inside) return ends;
  // The cylinder between the ends: the distance from its axis, without the component along it.
  const glm::dvec3 from = line.origin - foot;
  const double along = glm::dot(from, axis) / length2;
  const double speed = glm::dot(line.direction, axis) / length2;
  const glm::dvec3 aside = from - along * axis, turn = line.direction - speed * axis;
  const double a = glm::dot(turn, turn), b = glm::dot(aside, turn);
  const double c = glm::dot(aside, aside) - radius * radius;
  if (c <= 0 && along >= 0 && along <= 1) return begins_inside(line);
  const double root = b * b - a * c;
  if (a <= 0 || root < 0) return ends;
  const double t = (-b - std::sqrt(root)) / a, at = along + t * speed;
  if (t < 0 || t > longest || at < 0 || at > 1) return ends;
  return first_of(SolidHit{t, glm::vec3((aside + t * turn) / radius), false}, ends);
}

// The interval of a line inside some half-spaces.
struct Clip {
  double enters = 0, leaves;
  glm::vec3 normal{0.0F};
  bool moved = false;
  // Clips by the half-space with this normal, whose border is `gap` before the line's origin.
  bool cut(const glm::vec3& outwards, double gap, double speed) {
    if (speed == 0) return gap <= 0;
    const double t = -gap / speed;
    if (speed < 0 && gap > 0 && t >= enters) {
      enters = t;
      normal = outwards;
      moved = true;
    } else if (speed > 0) {
      leaves = std::min(leaves, t);
    }
    return enters <= leaves;
  }
  Hit hit(const Line& line) const {
    return moved ? Hit(SolidHit{enters, normal, false}) : begins_inside(line);
  }
};

Hit cast_box(const Line& line, double longest, const core::Bounds& box) {
  Clip clip{.leaves = longest};
  for (int i = 0; i < 3; ++i) {
    glm::vec3 axis(0.0F);
    axis[i] = 1;
    const double from = line.origin[i], speed = line.direction[i];
    if (!clip.cut(axis, from - static_cast<double>(box.max[i]), speed) ||
        !clip.cut(-axis, static_cast<double>(box.min[i]) - from, -speed))
      return std::nullopt;
  }
  return clip.hit(line);
}

Hit cast_hull(const Line& line, double longest, std::span<const HalfSpace> faces) {
  Clip clip{.leaves = longest};
  for (const HalfSpace& face : faces) {
    const glm::dvec3 normal(face.normal);
    if (!clip.cut(face.normal, glm::dot(normal, line.origin) - static_cast<double>(face.distance),
                  glm::dot(normal, line.direction)))
      return std::nullopt;
  }
  return clip.hit(line);
}

bool is_sound(const Collider::Shape& shape) {
  if (const auto* hull = std::get_if<Collider::Hull>(&shape))
    return hull->points.size() >= 4 &&
           std::ranges::all_of(hull->points, [](const glm::vec3& p) { return core::is_finite(p); });
  const core::Bounds box = bounds_of(shape);
  return core::is_finite(box.min) && core::is_finite(box.max) &&
         glm::all(glm::lessThan(box.min, box.max));
}

struct Face {
  std::array<std::size_t, 3> corners;
  glm::dvec3 normal;
  double distance;
  double above(const glm::dvec3& p) const { return glm::dot(normal, p) - distance; }
};

// Points, and the largest distance of a point that counts as on a face.
struct Cloud {
  std::vector<glm::dvec3> points;
  double tolerance = 0;

  Face face(std::size_t a, std::size_t b, std::size_t c) const {
    const glm::dvec3 across = glm::cross(points[b] - points[a], points[c] - points[a]);
    const double length = glm::length(across);
    const glm::dvec3 normal = length > 0 ? across / length : glm::dvec3(0);
    return {{a, b, c}, normal, glm::dot(normal, points[a])};
  }
  template <class Measure>
  std::pair<std::size_t, double> farthest(const Measure& measure) const {
    std::size_t best = 0;
    double most = -1;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double d = measure(points[i]);
      if (d > most) {
        most = d;
        best = i;
      }
    }
    return {best, most};
  }
};

// Makes a tetrahedron with corners far apart; empty if the points lie in one plane.
std::vector<Face> tetrahedron(const Cloud& cloud) {
  const auto& p = cloud.points;
  const std::size_t a = 0;
  const auto [b, length] = cloud.farthest([&](const auto& q) { return glm::length(q - p[a]); });
  if (length <= cloud.tolerance) return {};
  const glm::dvec3 along = (p[b] - p[a]) / length;
  const auto [c, width] =
      cloud.farthest([&](const auto& q) { return glm::length(glm::cross(q - p[a], along)); });
  if (width <= cloud.tolerance) return {};
  const Face base = cloud.face(a, b, c);
  const auto [d, height] = cloud.farthest([&](const auto& q) { return std::abs(base.above(q)); });
  if (height <= cloud.tolerance) return {};
  if (base.above(p[d]) < 0)
    return {base, cloud.face(a, d, b), cloud.face(b, d, c), cloud.face(c, d, a)};
  return {cloud.face(a, c, b), cloud.face(a, b, d), cloud.face(b, c, d), cloud.face(c, a, d)};
}

// Replaces the faces visible from point `i` by faces from their common border to the point.
void add_point(const Cloud& cloud, std::size_t i, std::vector<Face>& faces) {
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  std::erase_if(faces, [&](const Face& f) {
    if (f.above(cloud.points[i]) <= cloud.tolerance) return false;
    for (std::size_t k = 0; k < 3; ++k)
      edges.emplace_back(f.corners[k], f.corners[(k + 1) % 3]);
    return true;
  });
  for (const auto& [from, to] : edges) {
    if (std::ranges::find(edges, std::pair(to, from)) == edges.end())
      faces.push_back(cloud.face(from, to, i));
  }
}

}  // namespace

BoxLine::BoxLine(const Line& line) : origin(line.origin) {
  constexpr double kMin = 1e-100;
  for (int i = 0; i < 3; ++i) {
    const double d = line.direction[i];
    inverse[i] = 1 / (std::abs(d) < kMin ? std::copysign(kMin, d) : d);
  }
}

bool meets(const BoxLine& line, double longest, const core::Bounds& box) {
  constexpr double kMargin = 1e-3;
  double enters = 0, leaves = longest;
  for (int i = 0; i < 3; ++i) {
    const double a = (static_cast<double>(box.min[i]) - kMargin - line.origin[i]) * line.inverse[i];
    const double b = (static_cast<double>(box.max[i]) + kMargin - line.origin[i]) * line.inverse[i];
    enters = std::max(enters, std::min(a, b));
    leaves = std::min(leaves, std::max(a, b));
  }
  return enters <= leaves;
}

Hit cast(const Line& line, double longest, const Collider::Shape& shape,
         std::span<const HalfSpace> faces) {
  if (const auto* sphere = std::get_if<Collider::Sphere>(&shape))
    return cast_sphere(line, longest, glm::dvec3(sphere->centre),
                       static_cast<double>(sphere->radius));
  if (const auto* capsule = std::get_if<Collider::Capsule>(&shape))
    return cast_capsule(line, longest, *capsule);
  if (const auto* box = std::get_if<Collider::Box>(&shape)) return cast_box(line, longest, *box);
  return cast_hull(line, longest, faces);
}

Solid::Solid(models::Collider collider) {
  std::erase_if(collider.shapes, [](const auto& shape) { return !is_sound(shape); });
  collider_ = std::move(collider);
  for (const Collider::Shape& shape : collider_.shapes) {
    const core::Bounds box = bounds_of(shape);
    box_ = &shape == collider_.shapes.data() ? box : core::united(box_, box);
  }
}

std::size_t Solid::heap_bytes() const {
  std::size_t bytes = collider_.shapes.capacity() * sizeof(Collider::Shape);
  for (const Collider::Shape& shape : collider_.shapes) {
    const auto* hull = std::get_if<Collider::Hull>(&shape);
    if (hull == nullptr) continue;
    const std::size_t faces = 2 * hull->points.size();  // upper bound by Euler's formula
    bytes +=
        hull->points.capacity() * sizeof(glm::vec3) + sizeof faces_[0] + faces * sizeof(HalfSpace);
  }
  return bytes;
}

Hit Solid::cast(const Line& line, double longest) {
  Hit nearest;
  std::size_t hulls = 0;
  for (const Collider::Shape& shape : collider_.shapes) {
    std::span<const HalfSpace> faces;
    if (const auto* hull = std::get_if<Collider::Hull>(&shape)) {
      if (++hulls > faces_.size()) faces_.push_back(hull_faces(hull->points));
      faces = faces_[hulls - 1];
      if (faces.empty()) continue;
    }
    nearest = first_of(nearest, query::cast(line, nearest ? nearest->t : longest, shape, faces));
  }
  return nearest;
}

std::vector<HalfSpace> hull_faces(std::span<const glm::vec3> points) {
  if (points.size() < 4) return {};
  Cloud cloud;
  double extent = 0;
  for (const glm::vec3& p : points) {
    cloud.points.emplace_back(p);
    extent = std::max(extent, glm::length(cloud.points.back() - cloud.points.front()));
    if (!std::isfinite(p.x + p.y + p.z)) return {};
  }
  cloud.tolerance = 1e-6 * extent;
  std::vector<Face> faces = tetrahedron(cloud);
  if (faces.empty()) return {};
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    add_point(cloud, i, faces);
  std::vector<HalfSpace> result;
  for (const Face& f : faces) {
    // Slivers have no usable normal. Their neighbours bound the hull.
    if (f.normal != glm::dvec3(0))
      result.push_back({glm::vec3(f.normal), static_cast<float>(f.distance)});
  }
  return result;
}

}  // namespace psygen::query
