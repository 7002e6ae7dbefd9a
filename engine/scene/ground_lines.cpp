#include "engine/scene/ground_lines.hpp"

#include <algorithm>
#include <cmath>

namespace psygen::scene {
namespace {

constexpr std::size_t kPoints = GroundLines::kPoints;

// Vertices per side of a mesh with a skirt: n² + 4·(n − 1) = (n + 2)² − 8.
std::size_t side_of(std::size_t vertices) {
  return static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(vertices + 8)))) - 2;
}

// The vertex on a side of n that is point i of a line.
std::size_t vertex_of(std::size_t i, std::size_t n) {
  return i * (n - 1) / (kPoints - 1);
}

// How far the straight pieces between the points of a line lie above its vertices at most.
template <class Height>
float above(std::size_t n, const Height& height) {
  float most = 0;
  for (std::size_t i = 0; i + 1 < kPoints; ++i) {
    const std::size_t first = vertex_of(i, n), last = vertex_of(i + 1, n);
    const float from = height(first), rise = height(last) - from;
    for (std::size_t v = first + 1; v < last; ++v) {
      const float along = static_cast<float>(v - first) / static_cast<float>(last - first);
      most = std::max(most, from + along * rise - height(v));
    }
  }
  return most;
}

}  // namespace

GroundLines ground_lines(std::span<const core::TerrainVertex> vertices, float low_m, float range_m,
                         float off_m) {
  const std::size_t n = side_of(vertices.size());
  const auto height = [&](std::size_t x, std::size_t z) {
    // Wherever between its own height and the coarser one the vertex is drawn.
    const core::TerrainVertex& v = vertices[z * n + x];
    return low_m + static_cast<float>(std::min(v.height, v.coarse_height)) * (range_m / 65535.0F);
  };
  GroundLines lines;
  float above_m = 0;
  for (std::size_t i = 0; i < kPoints; ++i) {
    const std::size_t v = vertex_of(i, n);
    lines.place[i] = static_cast<float>(v) / static_cast<float>(n - 1);
    above_m = std::max(above_m, above(n, [&](std::size_t x) { return height(x, v); }));
    above_m = std::max(above_m, above(n, [&](std::size_t z) { return height(v, z); }));
    for (std::size_t k = 0; k < kPoints; ++k)
      lines.height_m[i * kPoints + k] = height(vertex_of(k, n), v);
  }
  lines.lower_by_m = above_m + off_m;
  return lines;
}

void add_lines(const GroundLines& lines, const glm::vec3& corner, float size_m,
               visibility::Horizon& horizon) {
  constexpr std::size_t kAdded[] = {0, 2, 5, kPoints - 1};
  const float half_m = size_m / 2;
  const bool rows = std::abs(corner.z + half_m) > std::abs(corner.x + half_m);
  for (const std::size_t across : kAdded) {
    std::array<glm::vec3, kPoints> line;
    for (std::size_t along = 0; along < kPoints; ++along) {
      const std::size_t x = rows ? along : across, z = rows ? across : along;
      line[along] = corner + glm::vec3(size_m * lines.place[x], lines.height_m[z * kPoints + x],
                                       size_m * lines.place[z]);
    }
    horizon.add(line, lines.lower_by_m);
  }
}

}  // namespace psygen::scene
