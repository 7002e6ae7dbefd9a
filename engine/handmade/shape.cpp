#include "engine/handmade/shape.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <span>

#include "engine/core/hash.hpp"
#include "engine/handmade/solid.hpp"
#include "engine/handmade/triangles.hpp"

namespace psygen::handmade {
namespace {

constexpr std::uint64_t kShapeEdition = 2;  // version of the level generation

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

}  // namespace

core::Result<std::shared_ptr<const Shape>> shape_of(const gltf::Model& model,
                                                    const world::HandmadeModel& how) {
  const auto triangles = triangles_of(model, how);
  if (!triangles) return tl::unexpected(triangles.error());
  auto shape = std::make_shared<Shape>();
  shape->levels = levels_of(*triangles, static_cast<int>(how.levels));
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
