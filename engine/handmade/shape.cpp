#include "engine/handmade/shape.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <string_view>

#include "engine/core/cancellation.hpp"
#include "engine/core/hash.hpp"
#include "engine/handmade/triangles.hpp"

namespace psygen::handmade {
namespace {

constexpr std::uint64_t kShapeEdition = 3;  // version of the level generation

// A hash of the file and the settings, independent of the simplifier.
std::uint64_t identity_of(const Triangles& triangles, const world::HandmadeModel& how) {
  std::uint64_t hash = core::combine(kShapeEdition, static_cast<std::uint64_t>(how.levels));
  hash = core::combine(hash, core::hash_bytes(std::as_bytes(std::span(how.collider))));
  for (const Vertex& v : triangles.vertices) {
    for (int i = 0; i < 3; ++i) {
      const std::uint64_t place = std::bit_cast<std::uint32_t>(v.position[i]);
      hash = core::combine(hash, place << 32 | std::bit_cast<std::uint32_t>(v.normal[i]));
    }
    hash = core::combine(hash, core::hash_bytes(std::as_bytes(std::span(v.colour)), v.leaf));
  }
  hash = core::combine(hash, core::hash_bytes(std::as_bytes(std::span(triangles.indices))));
  return std::max<std::uint64_t>(hash, 1);
}

float radius_of(const glm::vec3& p) {
  return std::sqrt(p.x * p.x + p.z * p.z);
}

constexpr float kFlat = 1e-3F;  // relative to the extent

template <class Far>
glm::vec3 farthest(const std::vector<glm::vec3>& points, const Far& far) {
  return *std::ranges::max_element(points, {}, far);
}

// True if all points are near one plane.
bool is_flat(const std::vector<glm::vec3>& points) {
  const glm::vec3 a = points.front();
  const glm::vec3 b = farthest(points, [&](const glm::vec3& p) { return glm::dot(p - a, p - a); });
  const float extent = glm::length(b - a);
  const auto off_line = [&](const glm::vec3& p) { return glm::length(glm::cross(p - a, b - a)); };
  const glm::vec3 c = farthest(points, off_line);
  if (!(off_line(c) > kFlat * extent * extent)) return true;
  const glm::vec3 normal = glm::normalize(glm::cross(b - a, c - a));
  const auto off_plane = [&](const glm::vec3& p) { return std::abs(glm::dot(p - a, normal)); };
  return !(off_plane(farthest(points, off_plane)) > kFlat * extent);
}

std::vector<glm::vec3> corners_of(const core::Bounds& box) {
  std::vector<glm::vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(glm::mix(box.min, box.max, glm::vec3(i & 1, i >> 1 & 1, i >> 2)));
  return corners;
}

// The extreme points in the directions of the surface of a lattice of 5 x 5 x 5 points. Of equal
// points the first in the mesh, so that the result does not depend on a sort.
std::vector<glm::vec3> extremes_of(const Triangles& triangles) {
  constexpr std::size_t kDirections = 98;
  std::array<float, kDirections> x{}, y{}, z{}, along{}, most{};
  std::array<std::uint32_t, kDirections> best{};
  std::size_t directions = 0;
  for (int i = 0; i < 125; ++i) {
    const glm::ivec3 at = glm::ivec3(i % 5, i / 5 % 5, i / 25) - 2;
    if (std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) < 2) continue;
    x[directions] = static_cast<float>(at.x);
    y[directions] = static_cast<float>(at.y);
    z[directions++] = static_cast<float>(at.z);
  }
  best.fill(triangles.indices.front());
  most.fill(-std::numeric_limits<float>::infinity());
  std::vector<bool> seen(triangles.vertices.size());
  for (const std::uint32_t k : triangles.indices) {
    if (seen[k]) continue;
    seen[k] = true;
    const glm::vec3 p = triangles.vertices[k].position;
    for (std::size_t d = 0; d < kDirections; ++d)
      along[d] = p.x * x[d] + p.y * y[d] + p.z * z[d];
    std::uint32_t rises = 0;
    for (std::size_t d = 0; d < kDirections; ++d)
      rises |= along[d] > most[d] ? 1U : 0U;
    for (std::size_t d = 0; rises != 0 && d < kDirections; ++d)
      if (along[d] > most[d]) best[d] = k, most[d] = along[d];
  }
  std::vector<glm::vec3> points;
  for (const std::uint32_t k : best) {
    const glm::vec3& p = triangles.vertices[k].position;
    if (std::ranges::find(points, p) == points.end()) points.push_back(p);
  }
  return points;
}

// The collider: a few points that span a convex hull. `kind` is one of world::kHandmadeColliders:
// the extreme points in 98 directions, the corners of the box, or none. Also none if all points lie
// in one plane, up to a thousandth of their extent.
std::vector<glm::vec3> solid_points(const Triangles& triangles, std::string_view kind) {
  std::vector<glm::vec3> points;
  if (kind == "box") points = corners_of(triangles.box);
  if (kind == "hull") points = extremes_of(triangles);
  if (points.size() < 4 || is_flat(points)) return {};
  return points;
}

}  // namespace

core::Result<std::shared_ptr<const Shape>> shape_of(const gltf::Model& model,
                                                    const world::HandmadeModel& how) {
  const auto triangles = triangles_of(model, how);
  if (!triangles) return tl::unexpected(triangles.error());
  auto shape = std::make_shared<Shape>();
  shape->levels = levels_of(*triangles, static_cast<int>(how.levels));
  if (auto ok = core::check_cancelled(); !ok) return tl::unexpected(ok.error());
  if (shape->levels.empty())
    return core::fail(core::ErrorCode::kParse, "all of its triangles have no area");
  shape->solid = solid_points(*triangles, how.collider);
  shape->box = triangles->box;
  for (const Level& level : shape->levels) {
    for (const Vertex& v : level.vertices) {
      shape->box = {glm::min(shape->box.min, v.position), glm::max(shape->box.max, v.position)};
      shape->radius_m = std::max(shape->radius_m, radius_of(v.position));
    }
  }
  for (const glm::vec3& p : shape->solid)
    shape->radius_m = std::max(shape->radius_m, radius_of(p));
  shape->identity = identity_of(*triangles, how);
  return shape;
}

}  // namespace psygen::handmade
