// Change points in a series of runs: the exact test of Mann and Whitney at every place, in both
// parts of a change again, corrected for the autocorrelation of the runs. At most 1 % of
// exchangeable series of up to 60 runs have a change by chance, whatever the distribution of their
// values. Spells of load, correlated runs and drifts have more (docs/frame-tests.md, "History").
// A ramp is not a step and may stay without a change. Pure.
#pragma once

#include <span>
#include <vector>

#include "engine/history/ranks.hpp"

namespace psygen::history {

struct ChangePoint {
  std::size_t at = 0;  // the first run after the change
  double effect = 0;   // median after less median before, up to the neighbouring changes
};

// The changes of a series of finite values, in order. Effects are at least `floor`. Longer series
// are cut into windows of 60 runs that overlap by 30. O(n) for long series.
std::vector<ChangePoint> change_points(std::span<const double> values, double floor,
                                       RankTails& tails);

}  // namespace psygen::history
