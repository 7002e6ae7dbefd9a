// How much light a cell of the world blocks, estimated from parameters before anything is
// generated. PLP's mode `solidity` accumulates it. An estimate for ordering work, not for hiding
// anything. Pure; usable from any thread; linear in the kinds.
#pragma once

#include <span>

namespace psygen::visibility {

// Objects of one kind at random places in a cell. All values are >= 0.
struct Standing {
  float count = 0;     // in the cell; may be an expected value
  float width_m = 0;   // seen from the side
  float height_m = 0;  // above the ground
  float density = 1;   // share of the light through its outline that it blocks
};

// The share in [0, 1] of the light through a square cell that the cell blocks. The light is level
// rays in all directions, at heights spread evenly over the `band_m` > 0 above the cell's lowest
// ground: the band in which the ground behind the cell is to be seen.
//
// - Ground: where a ray meets it, its height is spread evenly over `relief_m` >= 0 (highest less
//   lowest of the cell).
// - Objects: a ray of length l meets count · width · l / side² of them, Poisson distributed, in the
//   part of the band that they fill; the mean ray through a square is π / 4 sides long.
//
// All of these block light independently. The result never decreases when relief, counts, widths,
// heights or densities grow, and never increases when the side or the band grows.
float estimate_solidity(float side_m, float relief_m, std::span<const Standing> standing,
                        float band_m);

}  // namespace psygen::visibility
