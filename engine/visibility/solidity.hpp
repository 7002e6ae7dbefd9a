// Estimates from parameters, before anything is synthesised, how much light a cell of the world
// blocks. PLP's mode `solidity` accumulates it. Suitable for ordering work, not for hiding
// anything. Pure; any thread; linear in the kinds.
#pragma once

#include <span>

namespace psygen::visibility {

// Objects of one kind at random places in a cell. All values are >= 0.
struct Standing {
  float count = 0;     // in the cell; may be an expected value
  float width_m = 0;   // seen from the side
  float height_m = 0;  // above the ground
  float density = 1;   // fraction of the light through its outline that it blocks
};

// Returns the fraction in [0, 1] of the light through a square cell that the cell blocks. The light
// consists of level rays in all directions, at heights spread evenly over the `band_m` > 0 above
// the cell's lowest ground: the band in which the ground behind the cell may be visible.
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
