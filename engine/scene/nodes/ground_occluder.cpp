#include "engine/scene/nodes/ground_occluder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace psygen::scene {
namespace {

constexpr std::size_t kMaxPoints = GroundOccluder::kMaxPoints;

// Lowers both ends of each straight segment of a line by its maximum height above the vertices.
// `point(i)` is the vertex index of point i, `height(v)` the height of a vertex; `lattice` points
// to the height of the first point, and `step` leads to the next.
template <class PointOf, class Height>
void lower_line(std::size_t points, const PointOf& point, const Height& height, float* lattice,
                std::size_t step) {
  std::array<float, kMaxPoints> lower_by{};
  for (std::size_t i = 0; i + 1 < points; ++i) {
    const std::size_t first = point(i), last = point(i + 1);
    const float from = height(first), rise = height(last) - from;
    float above = 0;
    for (std::size_t v = first + 1; v < last; ++v) {
      const float along = static_cast<float>(v - first) / static_cast<float>(last - first);
      above = std::max(above, from + along * rise - height(v));
    }
    lower_by[i] = std::max(lower_by[i], above);
    lower_by[i + 1] = above;
  }
  for (std::size_t i = 0; i < points; ++i)
    lattice[i * step] = std::min(lattice[i * step], height(point(i)) - lower_by[i]);
}

template <class Height>
void set_lines(std::size_t n, const Height& lowest, GroundOccluder& occluder) {
  const std::size_t points = std::min(n, kMaxPoints);
  const auto point = [&](std::size_t i) { return i * (n - 1) / (points - 1); };
  occluder.points = points;
  occluder.height_m.fill(std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < points; ++i) {
    const std::size_t v = point(i);
    occluder.place[i] = static_cast<float>(v) / static_cast<float>(n - 1);
    lower_line(
        points, point, [&](std::size_t x) { return lowest(x, v); }, &occluder.height_m[i * points],
        1);
    lower_line(
        points, point, [&](std::size_t z) { return lowest(v, z); }, &occluder.height_m[i], points);
  }
}

float top_of_tile(std::span<const core::TerrainVertex> vertices, const models::TerrainGrid& grid,
                  int column, int row) {
  std::uint16_t top = 0;
  for (int z = grid.tile_line(row); z <= grid.tile_line(row + 1); ++z) {
    for (int x = grid.tile_line(column); x <= grid.tile_line(column + 1); ++x) {
      const core::TerrainVertex& v = vertices[static_cast<std::size_t>(z * grid.n + x)];
      top = std::max({top, v.height, v.coarse_height});
    }
  }
  return top;
}

}  // namespace

GroundOccluder ground_occluder(std::span<const core::TerrainVertex> vertices,
                               const models::TerrainGrid& grid, float low_m, float range_m,
                               float lower_by_m) {
  const auto n = static_cast<std::size_t>(grid.n);
  const float step_m = range_m / 65535.0F;
  const auto lowest = [&](std::size_t x, std::size_t z) {
    const core::TerrainVertex& v = vertices[z * n + x];
    return low_m - lower_by_m + static_cast<float>(std::min(v.height, v.coarse_height)) * step_m;
  };
  GroundOccluder occluder;
  set_lines(n, lowest, occluder);
  const int side = grid.tiles_per_side();
  for (int i = 0; i < side * side; ++i)
    occluder.top_m[static_cast<std::size_t>(i)] =
        low_m + top_of_tile(vertices, grid, i % side, i / side) * step_m;
  return occluder;
}

void add_lines(const GroundOccluder& occluder, const glm::vec3& corner, float size_m,
               visibility::Horizon& horizon) {
  const std::size_t points = occluder.points;
  const float half_m = size_m / 2;
  const bool rows = std::abs(corner.z + half_m) > std::abs(corner.x + half_m);
  const auto point = [&](std::size_t across, std::size_t along) {
    const std::size_t x = rows ? along : across, z = rows ? across : along;
    return corner + glm::vec3(size_m * occluder.place[x], occluder.height_m[z * points + x],
                              size_m * occluder.place[z]);
  };
  // Adds only lines that are the highest somewhere: one or two of a slope.
  std::array<float, kMaxPoints> highest;
  std::array<std::size_t, kMaxPoints> line_of{};
  highest.fill(-std::numeric_limits<float>::infinity());
  for (std::size_t across = 0; across < points; ++across) {
    for (std::size_t along = 0; along < points; ++along) {
      const glm::vec3 p = point(across, along);
      const float tangent = p.y / std::sqrt(p.x * p.x + p.z * p.z);
      if (!(tangent > highest[along])) continue;
      highest[along] = tangent;
      line_of[along] = across;
    }
  }
  std::array<bool, kMaxPoints> added{};
  for (std::size_t i = 0; i < points; ++i) {
    if (std::exchange(added[line_of[i]], true)) continue;
    std::array<glm::vec3, kMaxPoints> line;
    for (std::size_t along = 0; along < points; ++along)
      line[along] = point(line_of[i], along);
    horizon.add(std::span(line).first(points));
  }
}

}  // namespace psygen::scene
