// Prioritized-Layered Projection over a grid of blocks (Klosowski and Silva 2000, as the paper uses
// it in section 4.2): which blocks are seen, in order of importance, and which surround them.
// Neighbours are the eight cells around a cell. Knows no entities and nothing of what stands in a
// cell but, in the mode `solidity`, how much light it stops. Linear in the number of cells and in
// the largest key; allocates only while results grow.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/visibility/frustum.hpp"

namespace psygen::visibility {

inline constexpr std::uint16_t kUnvisited = UINT16_MAX;

// What a cell's key is (below).
enum class PlpMode : std::uint8_t { kLayers, kSolidity };

// Keys are in sixteenths of a layer.
inline constexpr std::uint32_t kKeysPerLayer = 16;

// A grid of width × depth cells, each at most 65,534; cell (x, z) has the index z · width + x.
struct PlpInput {
  std::uint32_t width = 0, depth = 0;
  std::uint32_t start_x = 0, start_z = 0;  // the camera's cell; outside: the nearest cell is taken
  std::span<const core::Bounds> bounds;    // of each cell, metres, relative to the camera
  const Frustum* frustum = nullptr;
  std::uint32_t max_visits = UINT32_MAX;  // the budget: cells taken from the front at most
  PlpMode mode = PlpMode::kLayers;
  // Of each cell, the share in [0, 1] of the light through it that it stops; not read in kLayers.
  std::span<const float> solidity = {};
  // By how many layers a cell of solidity 1 puts off what lies behind it, in [0, 64].
  float solidity_layers = 8;
};

// The key of the camera's cell is 0. In kLayers it is 16 × the layer, the number of steps from the
// camera's cell (Corrêa's heuristic; the paper's priority of a cell is −(layer + 1)). In kSolidity
// it is the solidity accumulated on the way from the camera's cell, projected along the step, with
// 16 for the step: let the cell be (dx, dz) from the camera's, |dx| >= |dz| (else with x and z
// exchanged). The line of sight to its middle passes from the cell s = (dx − sign dx, dz), straight
// before it, to d = (dx − sign dx, dz − sign dz), diagonally before it, in the proportion
// t = |dz| / |dx|, in steps of 1/256:
//   key = round((1 − t) · behind(s) + t · behind(d)),
//   behind(c) = key(c) + 16 + round(16 · solidity_layers · solidity(c)).
// So the key depends on nothing but the cells between; it is at least 16 × the layer and equals
// that where nothing is solid; making a cell more solid lowers no key; where all cells are equally
// solid the order is that of kLayers, in every respect.
//
// Cells leave the front by growing (key, in view before out of view, nearer first, smaller index
// first), where near is the distance from the camera to the cell's box. Every cell but the camera's
// has a neighbour with a smaller key, so no key is smaller than one that left before, and the
// search comes everywhere; for that reason it is done by sorting. Cells out of view are expanded
// too: from high above the ground every neighbour of the camera's cell may be out of view, and the
// search would end there.
//
// The caller keeps the result from tick to tick, so that nothing is allocated in the long run.
struct PlpResult {
  std::vector<std::uint16_t> layer;     // per cell; kUnvisited where the search did not come
  std::vector<std::uint32_t> key;       // per cell, visited or not
  std::vector<std::uint8_t> in_view;    // per cell: 1 or 0, visited or not
  std::vector<std::uint32_t> visible;   // visited cells in view, most important first
  std::vector<std::uint32_t> prefetch;  // visited cells out of view, most important first
  std::vector<std::uint32_t> front;     // not visited when the budget ended, most important first

  // Working memory. A sort key is the square of the distance as the bits of a float >= 0, which
  // sort like the float, above the cell.
  std::vector<std::uint32_t> distance_bits, behind;  // per cell
  std::vector<std::uint32_t> diagonal_shares;        // t · 256 along a ring
  std::vector<std::uint32_t> bucket_ends;  // for each key: of cells in view, then out of it
  std::vector<std::uint64_t> sorted, scratch;
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
