// The detail of heights: the same question always has the same answer, but a coarse node needs no
// features that fall between its vertices.
#pragma once

#include <cmath>

namespace psygen::models {

// Detail of level 0 is exact. Level d may leave out features narrower than 3 · 2^d cells of node
// level 0; which ones is a fixed part of each layer of the ground, so all nodes of one level agree
// at shared vertices.
struct GroundDetail {
  int level = 0;
  // Light averages over its samples: the noise and edits leave narrower features out too. Meshes
  // sample them.
  bool light = false;

  static constexpr GroundDetail of_node(int node_level) {
    return {node_level == 0 ? 0 : node_level + 1, false};
  }
  // Of grid `grid` of the light of a node (terrain/light.hpp).
  static constexpr GroundDetail of_light(int node_level, int grid) {
    return {node_level + 2 * grid + 1, true};
  }
  // The widest spacing of samples that asks for this detail, in cells of node level 0. Level > 0.
  double spacing_cells() const { return std::ldexp(3.0, level - 1); }
  friend bool operator==(const GroundDetail&, const GroundDetail&) = default;
};

}  // namespace psygen::models
