// The exact tests by which two sets of runs are compared. Runs come in pairs, one of A and one of B
// shortly after each other, in random order. If A and B are the same, exchanging the two runs of a
// pair changes nothing: all 2^n labellings are equally likely, and p is the share of them that is
// at least as extreme as what was seen (Fisher's randomisation test). No assumption about the
// noise. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace psygen::compare {

// So many pairs can be judged: with fewer no p is below 0.01, with more there are too many
// labellings.
inline constexpr std::size_t kFewestPairs = 7, kMostPairs = 12;

// One figure of each run. p that the sum of b − a is at least what it is. Requires equal sizes, at
// most kMostPairs. O(n 2^n).
double swap_test(std::span<const double> a, std::span<const double> b);

// Times of the frames of runs: [run][frame], all of one length of at least 1, above 0. Frame k does
// the same work in every run, so the minimum over a set's runs is that work without what others
// took.
using Times = std::vector<std::vector<double>>;

struct MinimaTest {
  double ratio = 1;          // sum of the minima of B over that of A
  double p_slower = 1;       // that chance alone gives this ratio or a larger one
  double p_faster = 1;       // … or a smaller one
  double low = 0, high = 0;  // of the ratio: what a two-sided test at 5 % does not refuse
  double tail_ratio = 1;  // mean of B's minima over A's, of the 1 % of frames where it is largest
  double p_tail = 1;      // that chance alone gives this tail or a larger one
};
// Requires equal sizes, at most kMostPairs. O(2^n n frames), some 100 times.
MinimaTest minima_test(const Times& a, const Times& b);

// Fisher's exact test: of `a_all` runs of A `a_hits` have a property, and of B likewise. p that B
// has at least so many if both are the same. Requires hits <= all.
double fisher_more(std::uint64_t a_hits, std::uint64_t a_all, std::uint64_t b_hits,
                   std::uint64_t b_all);

}  // namespace psygen::compare
