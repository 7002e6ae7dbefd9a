#include "engine/query/hull.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace psygen::query {
namespace {

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
