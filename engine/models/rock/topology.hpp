// The surface of a tetrahedron whose triangles are repeatedly split into four: the edge that each
// vertex halves, the triangles of each step, and the ring of neighbours around every vertex. All
// rocks share it; it knows no positions. Vertex numbers are nested: the vertices of n subdivisions
// are the first ones of n + 1. Built once, then read-only and usable from any thread.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/models/rock/rock.hpp"

namespace psygen::models {

// Triangles and shared vertices after n subdivisions: 4·4^n and 2·4^n + 2.
constexpr std::uint32_t rock_triangles(int subdivisions) {
  return 4U << (2 * subdivisions);
}
constexpr std::uint32_t rock_vertices(int subdivisions) {
  return rock_triangles(subdivisions) / 2 + 2;
}

// The tables of 0 … kMaxSubdivisions subdivisions. References stay valid while it lives.
class RockTopology {
 public:
  // Tables for kernels hold 4 · vertex, the offset of a vertex in an array with four floats for
  // each. At least kPad zeros follow the last entry.
  static constexpr std::size_t kPad = 16;
  using Offsets = std::vector<std::uint16_t>;

  // Builds all tables, linear in their size.
  RockTopology();

  // The two ends of the edge that vertex v >= 4 halves, at [v − 4]. Vertices 0 … 3 are the corners
  // of the tetrahedron.
  const std::array<Offsets, 2>& parents() const { return parents_; }
  // Triangles of n subdivisions, three vertices each, counter-clockwise from outside when the
  // tetrahedron is (+ + +), (+ − −), (− + −), (− − +). The four parts of a triangle stay together.
  std::span<const std::uint16_t> indices(int subdivisions) const {
    return indices_[static_cast<std::size_t>(subdivisions)];
  }
  // The same triangles as offsets: corner i of triangle t is at [i][t].
  const std::array<Offsets, 3>& corners(int subdivisions) const {
    return corners_[static_cast<std::size_t>(subdivisions)];
  }
  // The neighbours of vertex v, counter-clockwise seen from outside, at [0 … 5][v]. Three
  // neighbours are repeated as 0 1 2 2 2 0, which encloses the same area.
  const std::array<Offsets, 6>& rings(int subdivisions) const {
    return rings_[static_cast<std::size_t>(subdivisions)];
  }

 private:
  std::array<Offsets, 2> parents_;
  std::array<std::vector<std::uint16_t>, kMaxSubdivisions + 1> indices_;
  std::array<std::array<Offsets, 3>, kMaxSubdivisions + 1> corners_;
  std::array<std::array<Offsets, 6>, kMaxSubdivisions + 1> rings_;
};

}  // namespace psygen::models
