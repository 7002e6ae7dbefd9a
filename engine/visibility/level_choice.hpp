// Which level of detail a mesh needs: the coarsest one whose error covers few enough pixels, with
// hysteresis so that a camera on the border between two levels does not flicker. Pure functions;
// budgets are not their subject (a budget raises the error that is allowed).
#pragma once

#include <cstdint>
#include <span>

namespace psygen::visibility {

// Going to a coarser level demands that it has this share of the allowed error.
inline constexpr float kCoarserShare = 0.8F;

// Pixels that something `size_m` wide covers at `distance_m` > 0; with an error in metres, the
// error in pixels.
inline float projected_size_pixels(float size_m, float distance_m, float pixels_per_radian) {
  return size_m * pixels_per_radian / distance_m;
}

// The level for a mesh whose level l is level_errors_m[l] off (0 at level 0, growing). The distance
// is to the nearest point of the mesh; at 0 or less the finest level is taken. `current_level` is
// what is shown now, −1 for nothing. Without hysteresis (current −1) the result is the last level
// of those from 0 on whose error stays within max_error_pixels; a finer level than the current one
// is taken as soon as that is needed, a coarser one only within kCoarserShare of it. Level 0 if
// nothing suffices.
int choose_level(std::span<const float> level_errors_m, float distance_m, float pixels_per_radian,
                 float max_error_pixels, int current_level);

inline constexpr std::uint8_t kNoCurrentLevel = UINT8_MAX;

// The same for many meshes of `level_count` levels: level_errors_m has level_count values for each
// of them, one mesh after the other. `levels` holds the current levels (kNoCurrentLevel for none)
// and receives the new ones.
void choose_levels(std::span<const float> level_errors_m, std::uint32_t level_count,
                   std::span<const float> distances_m, float pixels_per_radian,
                   float max_error_pixels, std::span<std::uint8_t> levels);

}  // namespace psygen::visibility
