// Chooses the LOD of a mesh: the coarsest level whose error covers few enough pixels, with
// hysteresis, so that a camera on the border between two levels does not flicker. Enforces no
// budget: a budget raises the allowed error instead. Pure functions; any thread; linear in the
// levels.
#pragma once

#include <span>

namespace psygen::visibility {

// A coarser level is chosen only if its error is within this fraction of the allowed error.
inline constexpr float kCoarserShare = 0.8F;

// The level for a mesh whose level l has the error level_errors_m[l] (0 at level 0, ascending). The
// distance is that of the mesh's nearest point; 0 or less gives the finest level. `current_level`
// is the level shown now, −1 for none. With −1 the result is the coarsest level up to which every
// error stays within max_error_pixels. A finer level than the current one is chosen as soon as it
// is needed, a coarser one only within kCoarserShare of the allowed error. Level 0 if no level
// suffices.
int choose_level(std::span<const float> level_errors_m, float distance_m, float pixels_per_radian,
                 float max_error_pixels, int current_level);

}  // namespace psygen::visibility
