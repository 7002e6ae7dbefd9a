#include "engine/models/rock_topology.hpp"

namespace psygen::models {
namespace {

using Edge = RockTopology::Edge;

// A triangle with its edges: edge i runs between corner i and corner i + 1.
struct Triangle {
  std::array<std::uint16_t, 3> corner;
  std::array<std::uint32_t, 3> edge;
};

struct Surface {
  std::vector<Edge> edges;
  std::vector<Triangle> triangles;
};

// Halves of edge e become edges 2e (at its end a) and 2e + 1 (at its end b); its midpoint is vertex
// first_midpoint + e.
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

std::vector<RockTopology::Fan> fans_of(std::span<const std::uint16_t> corners,
                                       std::size_t vertex_count) {
  const std::size_t triangle_count = corners.size() / 3;
  RockTopology::Fan none;
  none.fill(static_cast<std::uint16_t>(triangle_count));
  std::vector<RockTopology::Fan> fans(vertex_count, none);
  std::vector<std::uint8_t> sizes(vertex_count);
  for (std::size_t i = 0; i < corners.size(); ++i)
    fans[corners[i]][sizes[corners[i]]++] = static_cast<std::uint16_t>(i / 3);
  return fans;
}

}  // namespace

RockTopology::RockTopology() {
  Surface surface;
  surface.edges = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
  surface.triangles = {{{0, 1, 2}, {0, 3, 1}},
                       {{0, 2, 3}, {1, 5, 2}},
                       {{0, 3, 1}, {2, 4, 0}},
                       {{1, 3, 2}, {4, 5, 3}}};
  parents_.reserve(rock_vertices(kMaxSubdivisions) - 4);
  for (int n = 0;; ++n) {
    std::vector<std::uint16_t>& list = indices_[static_cast<std::size_t>(n)];
    list.reserve(rock_triangles(n) * 3);
    for (const Triangle& t : surface.triangles)
      list.insert(list.end(), t.corner.begin(), t.corner.end());
    fans_[static_cast<std::size_t>(n)] = fans_of(list, rock_vertices(n));
    if (n == kMaxSubdivisions) return;
    parents_.insert(parents_.end(), surface.edges.begin(), surface.edges.end());
    surface = split(surface, rock_vertices(n));
  }
}

}  // namespace psygen::models
