// Simplifies loose leaves, which offer nothing to merge: each piece becomes a flat kite, and in
// coarser levels fewer and larger kites keep the total area (Cook, Halstead, Planck and Ryu,
// "Stochastic Simplification of Aggregate Detail", SIGGRAPH 2007). Coarser levels show a subset of
// the pieces of finer ones. Pure; any thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/handmade/triangles.hpp"

namespace psygen::handmade {

class Foliage {
 public:
  // From triangles of leaves; triangles that share positions form one piece. O(n log n).
  Foliage(const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices);

  std::size_t piece_count() const { return pieces_.size(); }
  // Appends kites with about `triangles` triangles to a mesh. Returns their maximum distance from
  // the leaves, in metres.
  double add(std::size_t triangles, std::vector<Vertex>& vertices,
             std::vector<std::uint32_t>& indices) const;

 private:
  struct Piece {
    glm::vec3 middle{0.0F}, along{0.0F}, across{0.0F};  // along, across: half its diagonals
    glm::vec3 normal{0.0F};
    std::array<std::uint8_t, 3> colour{};
    float area_m2 = 0;
  };
  static Piece piece_of(const std::vector<Vertex>& vertices,
                        const std::vector<std::uint32_t>& indices);

  std::vector<Piece> pieces_;  // the first pieces are left out last
  float reach_m_ = 0;          // of all pieces from their centre
  double area_m2_ = 0;
};

}  // namespace psygen::handmade
