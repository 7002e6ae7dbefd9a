// The levels of detail of a mesh. Pure; any thread. The same mesh gives the same levels, except
// that the order of triangles and the levels of loose parts depend on the version of meshoptimizer.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/handmade/triangles.hpp"

namespace psygen::handmade {

// One level: at most 65,536 vertices.
struct Level {
  std::vector<Vertex> vertices;
  std::vector<std::uint16_t> indices;
  double error_m = 0;  // of surface and looks (appearance.hpp); 0 at level 0, ascending
};

// One to `most` levels, each with about a quarter of the triangles of the previous one. The first
// has all different triangles, or as many as 65,536 vertices allow. If loose parts leave nothing to
// merge, coarse levels keep only the outline. Empty if all triangles are degenerate. About O(n).
std::vector<Level> levels_of(const Triangles& triangles, int most);

}  // namespace psygen::handmade
