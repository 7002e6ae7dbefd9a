// Prioritized-Layered Projection over a grid of blocks (Klosowski and Silva 2000, as the paper uses
// it in section 4.2): lists visible blocks in order of importance, and the blocks around them. A
// cell's neighbours are the eight cells around it. Knows no entities, and of a cell's contents
// only, in the mode `solidity`, the fraction of light that it blocks. Linear in the number of cells
// and in the largest key; allocates only while results grow. Any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/visibility/frustum.hpp"

namespace psygen::visibility {

// The layer of a cell that the search did not visit.
inline constexpr std::uint16_t kUnvisited = UINT16_MAX;

// Definition of a cell's key (see PlpResult).
enum class PlpMode : std::uint8_t { kLayers, kSolidity };

// Keys count sixteenths of a layer.
inline constexpr std::uint32_t kKeysPerLayer = 16;

// A grid of width × depth cells, each at most 65,534; cell (x, z) has the index z · width + x.
struct PlpInput {
  std::uint32_t width = 0, depth = 0;
  std::uint32_t start_x = 0, start_z = 0;  // the camera's cell; if outside, the nearest cell
  std::span<const core::Bounds> bounds;    // of each cell, metres, relative to the camera
  const Frustum* frustum = nullptr;
  std::uint32_t max_visits = UINT32_MAX;  // the budget: largest number of visited cells
  PlpMode mode = PlpMode::kLayers;
  // By cell: the fraction in [0, 1] of the light through the cell that it blocks. Unused in
  // kLayers.
  std::span<const float> solidity = {};
  // Number of layers by which a cell of solidity 1 delays the cells behind it, in [0, 64].
  float solidity_layers = 8;
};

// The key of the camera's cell is 0. In kLayers a key is 16 × the layer, the number of steps from
// the camera's cell (Corrêa's heuristic; the paper's priority of a cell is −(layer + 1)). In
// kSolidity it is the solidity accumulated on the way from the camera's cell, plus 16 for each
// step. Let the cell be (dx, dz) from the camera's, with |dx| >= |dz| (else exchange x and z). The
// line of sight to its centre passes between two cells: s = (dx − sign dx, dz), straight before it,
// and d = (dx − sign dx, dz − sign dz), diagonally before it. d has the weight t = |dz| / |dx|, in
// steps of 1/256:
//   key = round((1 − t) · behind(s) + t · behind(d)),
//   behind(c) = key(c) + 16 + round(16 · solidity_layers · solidity(c)).
// The key depends only on the cells in between. It is at least 16 × the layer, and equals it where
// nothing is solid. Making a cell more solid lowers no key. When all cells are equally solid, the
// order is exactly that of kLayers.
//
// Cells leave the front in ascending order of key; then cells in view before cells out of view,
// nearer cells first, smaller indices first. Near means the distance from the camera to the cell's
// box. Every cell except the camera's has a neighbour with a smaller key. So no cell leaves with a
// smaller key than one before it, and the search reaches every cell; it is therefore done by
// sorting. Cells out of view are expanded too: from high above the ground every neighbour of the
// camera's cell may be out of view, and the search would end there.
//
// The caller keeps the result from tick to tick, so nothing is allocated in the long run.
struct PlpResult {
  std::vector<std::uint16_t> layer;     // per cell; kUnvisited if the search did not reach it
  std::vector<std::uint32_t> key;       // per cell, visited or not
  std::vector<std::uint8_t> in_view;    // per cell: 1 or 0, visited or not
  std::vector<std::uint32_t> visible;   // visited cells in view, most important first
  std::vector<std::uint32_t> prefetch;  // visited cells out of view, most important first
  std::vector<std::uint32_t> front;     // not visited when the budget ended, most important first

  // Working memory. A sort key is the square of the distance, as the bits of a float >= 0 (which
  // sort like the float), above the index of the cell.
  std::vector<std::uint32_t> distance_bits, behind;  // per cell
  std::vector<std::uint32_t> diagonal_shares;        // t · 256 along a ring
  std::vector<std::uint32_t> bucket_ends;  // by key: of cells in view, then of cells out of view
  std::vector<std::uint64_t> sorted, scratch;
};

// Replaces the contents of `result`. An empty grid gives empty lists.
void run_plp(const PlpInput& input, PlpResult& result);

}  // namespace psygen::visibility
