// Which level of detail a mesh needs: the coarsest one whose error covers few enough pixels, with
// hysteresis, so a camera on the border between two levels does not flicker. Not a budget: a budget
// raises the allowed error instead. Pure functions; any thread; linear in the levels.
#pragma once

#include <cstdint>
#include <span>

namespace psygen::visibility {

// A coarser level is chosen only when its error is within this share of the allowed error.
inline constexpr float kCoarserShare = 0.8F;

// Pixels that something `size_m` wide covers at `distance_m` > 0. For an error in metres this is
// the error in pixels.
inline float projected_size_pixels(float size_m, float distance_m, float pixels_per_radian) {
  return size_m * pixels_per_radian / distance_m;
}

// The level for a mesh whose level l has the error level_errors_m[l] (0 at level 0, ascending). The
// distance is that of the mesh's nearest point; 0 or less gives the finest level. `current_level`
// is the level shown now, −1 for none. With −1 the result is the coarsest level up to which every
// error stays within max_error_pixels. A finer level than the current one is chosen as soon as it
// is needed, a coarser one only within kCoarserShare of the allowed error. Level 0 if no level
// suffices.
int choose_level(std::span<const float> level_errors_m, float distance_m, float pixels_per_radian,
                 float max_error_pixels, int current_level);

// No level is shown now (choose_levels).
inline constexpr std::uint8_t kNoCurrentLevel = UINT8_MAX;

// The same for many meshes of `level_count` levels each. level_errors_m has level_count values per
// mesh, one mesh after the other. `levels` holds the current levels (kNoCurrentLevel for none) and
// receives the new ones; its length is that of `distances_m`.
void choose_levels(std::span<const float> level_errors_m, std::uint32_t level_count,
                   std::span<const float> distances_m, float pixels_per_radian,
                   float max_error_pixels, std::span<std::uint8_t> levels);

}  // namespace psygen::visibility
