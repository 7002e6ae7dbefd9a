// Areas of meshes from the side and from above, and the meshes to measure.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "engine/core/assert.hpp"
#include "engine/models/kit/packing.hpp"
#include "engine/world/far/outline.hpp"

namespace psygen::world {
namespace {

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
  for (std::size_t i = 0; i < places.size(); ++i) {
    core::ModelVertex v;
    std::memcpy(&v, vertices_.data() + i * sizeof v, sizeof v);
    places[i] = models::unpack_position(v, box_);
  }
  return silhouette_of(places, indices(type));
}

}  // namespace psygen::world
