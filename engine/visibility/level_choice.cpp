#include "engine/visibility/level_choice.hpp"

#include <algorithm>

namespace psygen::visibility {
namespace {

// Returns the coarsest level up to which every error is at most `allowed_m`. NaN counts as too
// large.
int coarsest_within(std::span<const float> errors_m, float allowed_m) {
  int level = 0;
  while (level + 1 < static_cast<int>(errors_m.size()) &&
         errors_m[static_cast<std::size_t>(level) + 1] <= allowed_m)
    ++level;
  return level;
}

}  // namespace

int choose_level(std::span<const float> level_errors_m, float distance_m, float pixels_per_radian,
                 float max_error_pixels, int current_level) {
  const float allowed_m = max_error_pixels * std::max(distance_m, 0.0F) / pixels_per_radian;
  const int level = coarsest_within(level_errors_m, allowed_m);
  if (current_level < 0 || level <= current_level) return level;
  return std::max(current_level, coarsest_within(level_errors_m, allowed_m * kCoarserShare));
}

}  // namespace psygen::visibility
