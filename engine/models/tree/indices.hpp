// The index lists of sixteen tubes or sprays, made at compile time: a mesh repeats them with the
// numbers of its vertices added. Internal to trees.
#pragma once

#include "engine/models/tree/mesh.hpp"

namespace psygen::models {

// Of tubes that tube_plan() knows; 16 · 3 · triangles() long and aligned to 64 bytes. `in_block`:
// vertex v of the i-th tube is number 16 v + 4 (i mod 4) + ⌊i / 4⌋, otherwise tubes follow each
// other.
const std::uint16_t* tube_pattern(const TubePlan& tube, bool in_block);
// Of sprays in a block; likewise.
const std::uint16_t* spray_pattern(const SprayForm& form);

}  // namespace psygen::models
