#include "engine/world/far/outline.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/core/assert.hpp"
#include "engine/models/kit/packing.hpp"

namespace psygen::world {
namespace {

core::ModelVertex vertex_at(std::span<const std::byte> vertices, std::size_t i) {
  core::ModelVertex v;
  std::memcpy(&v, vertices.data() + i * sizeof v, sizeof v);
  return v;
}

// The vertices furthest along ±x, ±y, ±z of all that were added.
struct Extremes {
  std::array<std::size_t, 6> at{};  // −x, −y, −z, +x, +y, +z
  std::size_t count = 0;

  void add(const core::ModelVertex& v, std::size_t i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int16_t q = v.position[axis];
      if (count == 0 || q < min_[axis]) {
        min_[axis] = q;
        at[axis] = i;
      }
      if (count == 0 || q > max_[axis]) {
        max_[axis] = q;
        at[3 + axis] = i;
      }
    }
    ++count;
  }

 private:
  std::array<std::int16_t, 3> min_{}, max_{};
};

// Sets the foot to the mean of the vertices that are not leaves, and the trunk's radius to the
// largest distance of their lowest tenth from the axis through the foot.
void measure_trunk(std::span<const std::byte> vertices, const core::Bounds& box, Outline& outline) {
  const std::size_t count = vertices.size() / sizeof(core::ModelVertex);
  float lowest = 0, highest = 0, solids = 0;
  Corner sum;
  sum.ambient = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const core::ModelVertex v = vertex_at(vertices, i);
    if (v.material == kLeaf) continue;
    const Corner c = corner_of(v, box);
    lowest = solids == 0 ? c.position.y : std::min(lowest, c.position.y);
    highest = solids == 0 ? c.position.y : std::max(highest, c.position.y);
    sum.colour += c.colour;
    sum.ambient += c.ambient;
    ++solids;
  }
  if (solids == 0) return;
  sum.colour *= 1 / solids;
  sum.ambient *= 1 / solids;
  sum.position = {0, lowest, 0};
  outline.foot = sum;
  for (std::size_t i = 0; i < count; ++i) {
    const core::ModelVertex v = vertex_at(vertices, i);
    const glm::vec3 p = models::unpack_position(v, box);
    if (v.material == kLeaf || p.y > lowest + 0.1F * (highest - lowest)) continue;
    outline.trunk_radius = std::max(outline.trunk_radius, std::sqrt(p.x * p.x + p.z * p.z));
  }
}

constexpr int kCells = 48;  // per side of the raster

// A raster over the extent of the triangles in one projection. Only parts above `floor` count.
class Raster {
 public:
  Raster(std::span<const glm::vec2> points, float floor) : low_(points[0]), high_(points[0]) {
    for (const glm::vec2 p : points) {
      low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
      high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
    }
    low_.y = std::max(low_.y, floor);
    cell_ = {(high_.x - low_.x) / kCells, (high_.y - low_.y) / kCells};
  }
  bool empty() const { return !(cell_.x > 0 && cell_.y > 0); }

  void add(glm::vec2 a, glm::vec2 b, glm::vec2 c) {
    const int first = row_of(std::min({a.y, b.y, c.y})), last = row_of(std::max({a.y, b.y, c.y}));
    for (int row = first; row <= last; ++row) {
      const float y = low_.y + (static_cast<float>(row) + 0.5F) * cell_.y;
      float from = high_.x, to = low_.x;
      for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
        if ((p.y <= y) == (q.y <= y)) continue;
        const float x = p.x + (q.x - p.x) * ((y - p.y) / (q.y - p.y));
        from = std::min(from, x);
        to = std::max(to, x);
      }
      const auto begin = static_cast<int>(std::ceil((from - low_.x) / cell_.x - 0.5F));
      const auto end = static_cast<int>(std::floor((to - low_.x) / cell_.x - 0.5F));
      for (int x = std::max(begin, 0); x <= std::min(end, kCells - 1); ++x)
        set_[static_cast<std::size_t>(row * kCells + x)] = true;
    }
  }
  float area() const {
    return static_cast<float>(std::count(set_.begin(), set_.end(), true)) * cell_.x * cell_.y;
  }

 private:
  int row_of(float y) const {
    return std::clamp(static_cast<int>((y - low_.y) / cell_.y), 0, kCells - 1);
  }
  glm::vec2 low_, high_, cell_{0.0F};
  std::array<bool, static_cast<std::size_t>(kCells) * kCells> set_{};
};

float area_of(std::span<const glm::vec2> points, std::span<const std::uint16_t> indices,
              float floor) {
  Raster raster(points, floor);
  if (raster.empty()) return 0;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
    raster.add(points[indices[i]], points[indices[i + 1]], points[indices[i + 2]]);
  return raster.area();
}

}  // namespace

Corner corner_of(const core::ModelVertex& v, const core::Bounds& box) {
  const glm::vec3 colour = glm::vec3(v.colour[0], v.colour[1], v.colour[2]) * (1.0F / 255.0F);
  return {models::unpack_position(v, box),
          models::decode_octahedral(glm::vec2(v.normal[0], v.normal[1]) * (1.0F / 32767.0F)),
          colour,
          static_cast<float>(v.ambient) * (1.0F / 255.0F),
          static_cast<float>(v.sway) * (1.0F / 255.0F),
          static_cast<std::uint8_t>(v.material & kLeaf)};
}

Corner mixed(const Corner& a, const Corner& b, float t) {
  const float s = 1 - t;
  return {a.position * s + b.position * t, a.normal * s + b.normal * t, a.colour * s + b.colour * t,
          a.ambient * s + b.ambient * t,   a.sway * s + b.sway * t,     a.material};
}

glm::vec2 Outline::axis() const {
  const glm::vec3 sum = ring[0].position + ring[1].position + ring[2].position + ring[3].position;
  return {0.25F * sum.x, 0.25F * sum.z};
}

float Outline::ring_height() const {
  return 0.25F *
         (ring[0].position.y + ring[1].position.y + ring[2].position.y + ring[3].position.y);
}

float Outline::ring_radius() const {
  const glm::vec2 middle = axis();
  float sum = 0;
  for (const Corner& c : ring) {
    const float x = c.position.x - middle.x, z = c.position.z - middle.y;
    sum += std::sqrt(x * x + z * z);
  }
  return 0.25F * sum;
}

Corner Outline::mean_ring() const {
  Corner mean = mixed(mixed(ring[0], ring[1], 0.5F), mixed(ring[2], ring[3], 0.5F), 0.5F);
  mean.normal = {0, 1, 0};
  return mean;
}

Outline Outline::scaled(float across, float up) const {
  Outline result = *this;
  const glm::vec3 scale{across, up, across};
  for (Corner* c : {&result.top, &result.bottom, &result.ring[0], &result.ring[1], &result.ring[2],
                    &result.ring[3], &result.foot})
    c->position *= scale;
  result.trunk_radius *= across;
  return result;
}

std::optional<Outline> outline_of(std::span<const std::byte> vertices, const core::Bounds& box) {
  const std::size_t count = vertices.size() / sizeof(core::ModelVertex);
  if (count == 0) return std::nullopt;
  Extremes leaves, all;
  for (std::size_t i = 0; i < count; ++i) {
    const core::ModelVertex v = vertex_at(vertices, i);
    all.add(v, i);
    if (v.material == kLeaf) leaves.add(v, i);
  }
  Outline outline;
  outline.leafy = leaves.count > 0;
  const Extremes& chosen = outline.leafy ? leaves : all;
  const auto corner = [&](std::size_t i) {
    return corner_of(vertex_at(vertices, chosen.at[i]), box);
  };
  outline.top = corner(4);
  outline.bottom = corner(1);
  outline.ring = {corner(3), corner(5), corner(0), corner(2)};
  if (outline.leafy) measure_trunk(vertices, box, outline);
  return outline;
}

Silhouette silhouette_of(std::span<const glm::vec3> places,
                         std::span<const std::uint16_t> indices) {
  if (places.empty()) return {};
  constexpr float kHalfRoot = 0.70710678F;
  constexpr std::array<glm::vec2, 4> kAlong{
      {{1, 0}, {0, 1}, {kHalfRoot, kHalfRoot}, {kHalfRoot, -kHalfRoot}}};
  std::vector<glm::vec2> points(places.size());
  Silhouette sum;
  for (const glm::vec2 along : kAlong) {
    for (std::size_t i = 0; i < places.size(); ++i)
      points[i] = {places[i].x * along.x + places[i].z * along.y, places[i].y};
    sum.side_m2 += 0.25F * area_of(points, indices, 0);
  }
  float lowest = places[0].x;
  for (std::size_t i = 0; i < places.size(); ++i) {
    points[i] = {places[i].z, places[i].x};
    lowest = std::min(lowest, places[i].x);
  }
  sum.plan_m2 = area_of(points, indices, lowest);
  return sum;
}

void SampleMesh::make(const models::ModelType& type, const models::Parameters& p, int level) {
  size_ = type.mesh_size(p, level);
  PSYGEN_CHECK(size_.layout == core::VertexLayout::kModel, "models must consist of ModelVertex");
  box_ = type.bounds(p);
  vertices_.resize(size_.vertex_count * sizeof(core::ModelVertex));
  indices_.resize(size_.own_index_count());
  type.synthesise(p, level, {vertices_, indices_});
}

std::vector<std::uint16_t> SampleMesh::indices(const models::ModelType& type) const {
  if (size_.shared_indices == 0) return indices_;
  std::vector<std::uint16_t> shared(size_.index_count);
  type.write_shared_indices(size_.shared_indices, shared);
  return shared;
}

Silhouette SampleMesh::silhouette(const models::ModelType& type) const {
  std::vector<glm::vec3> places(size_.vertex_count);
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i] = models::unpack_position(vertex_at(vertices_, i), box_);
  return silhouette_of(places, indices(type));
}

}  // namespace psygen::world
