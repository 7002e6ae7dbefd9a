// Loose leaves in coarser levels, where there is nothing to be merged: each piece becomes a flat
// kite, and further away fewer and larger kites have the area of all (Cook, Halstead, Planck and
// Ryu, "Stochastic Simplification of Aggregate Detail", SIGGRAPH 2007). Coarser levels show some of
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
  // Of triangles of leaves; those that share places are one piece. O(n log n).
  Foliage(const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices);

  std::size_t piece_count() const { return pieces_.size(); }
  // About so many triangles, at the end of a mesh. Returns how far they may be from the leaves, in
  // metres.
  double add(std::size_t triangles, std::vector<Vertex>& vertices,
             std::vector<std::uint32_t>& indices) const;

 private:
  struct Piece {
    glm::vec3 middle{0.0F}, along{0.0F}, across{0.0F};  // half of its diagonals
    glm::vec3 normal{0.0F};
    std::array<std::uint8_t, 3> colour{};
    float area_m2 = 0;
  };
  static Piece piece_of(const std::vector<Vertex>& vertices,
                        const std::vector<std::uint32_t>& indices);

  std::vector<Piece> pieces_;  // in the order in which they are left out last
  float reach_m_ = 0;          // of all of them from their middle
  double area_m2_ = 0;
};

}  // namespace psygen::handmade
