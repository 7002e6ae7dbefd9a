// The surface of a tetrahedron whose triangles are split into four again and again: who is the
// midpoint of whom, and the triangles of each step. Constant, so all rocks share it. Vertex numbers
// are nested: those of n subdivisions are the first ones of n + 1. Built once, then read-only.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace psygen::models {

inline constexpr int kMaxSubdivisions = 6;

constexpr std::uint32_t rock_triangles(int subdivisions) {
  return 4U << (2 * subdivisions);
}
constexpr std::uint32_t rock_vertices(int subdivisions) {
  return rock_triangles(subdivisions) / 2 + 2;
}

class RockTopology {
 public:
  struct Edge {
    std::uint16_t a, b;
  };
  // The triangles around a vertex, ascending; where there are fewer than six, the others are
  // rock_triangles(n), one more than the last.
  using Fan = std::array<std::uint16_t, 6>;

  RockTopology();

  // The edge that vertex v >= 4 halves, at [v − 4]. Vertices 0 … 3 are the tetrahedron's.
  std::span<const Edge> parents() const { return parents_; }
  // Triangles of n subdivisions, three vertices each, counter-clockwise from outside when the
  // tetrahedron is (+ + +), (+ − −), (− + −), (− − +). The four parts of a triangle stay together.
  std::span<const std::uint16_t> indices(int subdivisions) const {
    return indices_[static_cast<std::size_t>(subdivisions)];
  }
  // One for each vertex of n subdivisions.
  std::span<const Fan> fans(int subdivisions) const {
    return fans_[static_cast<std::size_t>(subdivisions)];
  }

 private:
  std::vector<Edge> parents_;
  std::array<std::vector<std::uint16_t>, kMaxSubdivisions + 1> indices_;
  std::array<std::vector<Fan>, kMaxSubdivisions + 1> fans_;
};

}  // namespace psygen::models
