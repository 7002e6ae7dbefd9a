// Estimates the solidity of a node from parameters, before any mesh exists: heights of its ground
// at some points, and its scattered models. For PLP's mode `solidity` (engine/visibility/plp.hpp),
// which defers nodes behind solid ones. Suitable for ordering work, not for hiding anything. Pure.
#pragma once

#include <span>
#include <vector>

#include "engine/models/registry.hpp"
#include "engine/visibility/quadtree.hpp"
#include "engine/world/world.hpp"

namespace psygen::scene {

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

// The scattered obstacles on a block, each with the middle of its parameter ranges.
std::vector<Standing> obstacles_on_block(const world::World& world,
                                         const models::Registry& registry);

// Returns the solidity in [0, 1]. Takes some microseconds.
float node_solidity(const world::World& world, std::span<const Standing> on_block,
                    const visibility::NodeCoord& node);

}  // namespace psygen::scene
