#include "engine/models/rock/topology.hpp"

#include <algorithm>

namespace psygen::models {
namespace {

struct Edge {
  std::uint16_t a, b;
};

// A triangle with its edges. Edge i joins corners i and i + 1.
struct Triangle {
  std::array<std::uint16_t, 3> corner;
  std::array<std::uint32_t, 3> edge;
};

struct Surface {
  std::vector<Edge> edges;
  std::vector<Triangle> triangles;
};

// The halves of edge e become edges 2e (at its end a) and 2e + 1 (at its end b). Its midpoint is
// vertex first_midpoint + e.
Surface split(const Surface& coarse, std::uint32_t first_midpoint) {
  Surface fine;
  const auto midpoint = [&](std::uint32_t edge) {
    return static_cast<std::uint16_t>(first_midpoint + edge);
  };
  for (std::uint32_t e = 0; e < coarse.edges.size(); ++e) {
    fine.edges.push_back({coarse.edges[e].a, midpoint(e)});
    fine.edges.push_back({midpoint(e), coarse.edges[e].b});
  }
  for (const Triangle& t : coarse.triangles) {
    std::array<std::uint16_t, 3> m;
    for (std::size_t i = 0; i < 3; ++i)
      m[i] = midpoint(t.edge[i]);
    const auto inner = static_cast<std::uint32_t>(fine.edges.size());
    // Inner edge i joins the two midpoints next to corner i.
    for (std::size_t i = 0; i < 3; ++i)
      fine.edges.push_back({m[i], m[(i + 2) % 3]});
    const auto half = [&](std::size_t edge, std::uint16_t end) {
      return 2 * t.edge[edge] + (coarse.edges[t.edge[edge]].a == end ? 0U : 1U);
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t before = (i + 2) % 3;
      fine.triangles.push_back({{t.corner[i], m[i], m[before]},
                                {half(i, t.corner[i]), inner + static_cast<std::uint32_t>(i),
                                 half(before, t.corner[i])}});
    }
    fine.triangles.push_back({{m[0], m[1], m[2]}, {inner + 1, inner + 2, inner}});
  }
  return fine;
}

constexpr std::uint16_t offset_of(std::uint16_t vertex) {
  return static_cast<std::uint16_t>(4 * vertex);
}

std::array<RockTopology::Offsets, 3> corners_of(std::span<const std::uint16_t> indices) {
  std::array<RockTopology::Offsets, 3> corners;
  for (RockTopology::Offsets& list : corners)
    list.assign(indices.size() / 3 + RockTopology::kPad, 0);
  for (std::size_t i = 0; i < indices.size(); ++i)
    corners[i % 3][i / 3] = offset_of(indices[i]);
  return corners;
}

// Returns the neighbours of a vertex in order. `sides` has the two other corners of each triangle
// around it.
std::array<std::uint16_t, 6> ring_of(std::span<const std::array<std::uint16_t, 2>> sides) {
  std::array<std::uint16_t, 6> ring{};
  std::uint16_t at = sides[0][0];
  for (std::size_t i = 0; i < sides.size(); ++i) {
    ring[i] = at;
    const auto next = std::ranges::find(sides, at, [](const auto& side) { return side[0]; });
    at = (*next)[1];
  }
  if (sides.size() == 3) {
    ring[3] = ring[4] = ring[2];
    ring[5] = ring[0];
  }
  return ring;
}

std::array<RockTopology::Offsets, 6> rings_of(std::span<const std::uint16_t> indices,
                                              std::size_t vertex_count) {
  std::vector<std::vector<std::array<std::uint16_t, 2>>> sides(vertex_count);
  for (std::size_t t = 0; t < indices.size(); t += 3) {
    for (std::size_t i = 0; i < 3; ++i)
      sides[indices[t + i]].push_back({indices[t + (i + 1) % 3], indices[t + (i + 2) % 3]});
  }
  std::array<RockTopology::Offsets, 6> rings;
  for (RockTopology::Offsets& list : rings)
    list.assign(vertex_count + RockTopology::kPad, 0);
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const std::array<std::uint16_t, 6> ring = ring_of(sides[v]);
    for (std::size_t i = 0; i < 6; ++i)
      rings[i][v] = offset_of(ring[i]);
  }
  return rings;
}

}  // namespace

RockTopology::RockTopology() {
  Surface surface;
  surface.edges = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  surface.triangles = {{{0, 1, 2}, {0, 3, 1}},
                       {{0, 2, 3}, {1, 5, 2}},
                       {{0, 3, 1}, {2, 4, 0}},
                       {{1, 3, 2}, {4, 5, 3}}};
  for (int n = 0;; ++n) {
    const auto step = static_cast<std::size_t>(n);
    std::vector<std::uint16_t>& list = indices_[step];
    list.reserve(rock_triangles(n) * 3);
    for (const Triangle& t : surface.triangles)
      list.insert(list.end(), t.corner.begin(), t.corner.end());
    corners_[step] = corners_of(list);
    rings_[step] = rings_of(list, rock_vertices(n));
    if (n == kMaxSubdivisions) break;
    for (const Edge& e : surface.edges) {
      parents_[0].push_back(offset_of(e.a));
      parents_[1].push_back(offset_of(e.b));
    }
    surface = split(surface, rock_vertices(n));
  }
  for (Offsets& list : parents_)
    list.resize(list.size() + kPad);
}

}  // namespace psygen::models
