// Prioritized-Layered Projection over a grid of blocks (Klosowski and Silva, as the paper uses it
// in section 4.2; mode "layers", Corrêa's heuristic): which blocks are seen, in order of
// importance, and which surround them. Neighbours are the eight cells around a cell, so the layer
// is the breadth-first distance from the camera's cell. Knows no entities and nothing of what
// stands in a cell. Linear in the number of cells; allocates only while results grow.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/visibility/frustum.hpp"

namespace psygen::visibility {

inline constexpr std::uint16_t kUnvisited = UINT16_MAX;

// A grid of width × depth cells, each at most 65,534; cell (x, z) has the index z · width + x.
struct PlpInput {
  std::uint32_t width = 0, depth = 0;
  std::uint32_t start_x = 0, start_z = 0;  // the camera's cell; outside: the nearest cell is taken
  std::span<const core::Bounds> bounds;    // of each cell, metres, relative to the camera
  const Frustum* frustum = nullptr;
  std::uint32_t max_visits = UINT32_MAX;  // the budget: cells taken from the front at most
};

// The caller keeps it from tick to tick, so that nothing is allocated in the long run.
//
// Cells leave the front by growing key (layer, in view before out of view, nearer first, smaller
// index first), where near is the distance from the camera to the cell's box. Cells out of view
// are expanded too: from high above the ground every neighbour of the camera's cell may be out of
// view, and the search would end there. The paper's priority of a cell is −(layer + 1).
struct PlpResult {
  std::vector<std::uint16_t> layer;     // per cell; kUnvisited where the search did not come
  std::vector<std::uint8_t> in_view;    // per cell: 1 or 0, visited or not
  std::vector<std::uint32_t> visible;   // visited cells in view, most important first
  std::vector<std::uint32_t> prefetch;  // visited cells out of view, most important first
  std::vector<std::uint32_t> front;     // not visited when the budget ended, most important first

  // Working memory. A key is the square of the distance as the bits of a float >= 0, which sort
  // like the float, above the cell: smaller keys leave the front first.
  using Keys = std::vector<std::uint64_t>;
  using Lists = std::array<Keys, 2>;         // out of view, in view
  std::vector<std::uint32_t> distance_bits;  // per cell
  Lists current, next;                       // of the layer being visited, of the next
  Keys scratch;
};

void run_plp(const PlpInput& input, PlpResult& result);

struct GridCell {
  std::uint32_t x = 0, z = 0;
};

// The cell of `block` in a grid whose cell (0, 0) is the block `corner`, or the nearest cell if the
// block lies outside. Requires width, depth >= 1.
GridCell nearest_cell(core::BlockCoord corner, std::uint32_t width, std::uint32_t depth,
                      core::BlockCoord block);

}  // namespace psygen::visibility
