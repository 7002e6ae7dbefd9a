// The index lists of sixteen tubes or sprays, built at compile time. A mesh repeats them and adds
// the numbers of its first vertices. Constant data, any thread. Internal to trees.
#pragma once

#include "engine/models/tree/mesh.hpp"

namespace psygen::models {

// The list of sixteen tubes: 16 · 3 · tube.triangles() indices, aligned to 64 bytes. `tube` must be
// one of tube_plan(). With `in_block`, vertex v of tube i has the number
// 16 v + 4 (i mod 4) + ⌊i / 4⌋; otherwise the tubes follow each other.
const std::uint16_t* tube_pattern(const TubePlan& tube, bool in_block);
// The list of sixteen sprays in a block, with the same order of vertices. `form` must be one of the
// objects in spray_forms.hpp.
const std::uint16_t* spray_pattern(const SprayForm& form);

}  // namespace psygen::models
