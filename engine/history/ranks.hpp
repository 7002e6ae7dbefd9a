// Rank statistics of runs: the exact test of Mann and Whitney between the runs before and after a
// place, the autocorrelation of ranks, and robust spreads. No random numbers. Pure, but for the
// cache of RankTails; one thread at a time.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "engine/compare/statistics.hpp"

namespace psygen::history {

using compare::kRobust;
using compare::median;
using compare::pairs_above;

// Runs that each side of a change needs.
inline constexpr std::size_t kFewestRuns = 5;
// A change has p <= 1 %, and at least 1.5 robust standard deviations of a run.
inline constexpr double kSignificant = 0.01, kMinSpreads = 1.5;

// Exact distributions of Mann and Whitney's U, computed once for each pair of sizes.
class RankTails {
 public:
  // Two-sided p of n runs before and m after: `above` pairs have the larger value after, ties
  // counted half. Ties count against a change. Requires n and m from 1, and above <= n m.
  double p(std::size_t n, std::size_t m, double above);

 private:
  std::map<std::pair<std::size_t, std::size_t>, std::vector<double>> tails_;
};

// Ranks from −(n − 1)/2 to (n − 1)/2; equal values share their mean rank. O(n log n).
std::vector<double> mid_ranks(std::span<const double> values);

// Lag-1 autocorrelation of the mid-ranks of residuals less `margin`, between 0 and 0.8; 0 below 20
// values.
double rank_correlation(std::span<const double> residuals, double margin);

// z of a two-sided p, at most 0; p below 1e-15 counts as 1e-15. And the two-sided p of z.
double z_of(double p);
double p_of(double z);

// z for runs with this autocorrelation: z / √((1 + ρ) / (1 − ρ)).
double corrected(double z, double correlation);

}  // namespace psygen::history
