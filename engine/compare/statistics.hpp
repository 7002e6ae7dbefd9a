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
inline constexpr std::size_t kFewestPairs = 7, kMaxPairs = 12;

// One figure of each run. p that the sum of b − a is at least what it is. Requires equal sizes, at
// most 2 kMaxPairs. O(n 2^n).
double swap_test(std::span<const double> a, std::span<const double> b);

// Times of the frames of runs: [run][frame], all of one length of at least 1, above 0. Frame k does
// the same work in every run, so the minimum over a set's runs is that work without what others
// took. With frames in flight a frame that follows a delayed one waits less, so minima are taken of
// windows: sums over 10 successive frames.
using Times = std::vector<std::vector<double>>;

struct MinimaTest {
  double ratio = 1;          // sum of the minima of B over that of A
  double p_slower = 1;       // that chance alone gives this ratio or a larger one
  double p_faster = 1;       // … or a smaller one
  double low = 0, high = 0;  // of the ratio: what a two-sided test at 5 % does not refuse
};
// Requires equal sizes, 2 to kMaxPairs. O(2^n n frames), some 100 times.
MinimaTest minima_test(const Times& a, const Times& b);

// What the sum hides: of windows of 3 frames, the second least of a set's runs, B's over A's, and
// the mean of that over the 1 % of windows where it is largest.
struct TailTest {
  double ratio = 1;
  double p = 1;  // that chance alone gives this ratio or a larger one; of 4096 labellings at random
};
// Requires equal sizes, 2 to 2 kMaxPairs.
TailTest tail_test(const Times& a, const Times& b);

// Of each run, how slow its rare frames are: the mean logarithm of the largest 1.5 % of the ratios
// of a frame's time to its lower quartile over all runs. Half of these may be slow in the same
// frame.
std::vector<double> rare_frames(const Times& runs);

// Fisher's exact test: of `a_all` runs of A `a_hits` have a property, and of B likewise. p that B
// has at least so many if both are the same. Requires hits <= all.
double fisher_more(std::uint64_t a_hits, std::uint64_t a_all, std::uint64_t b_hits,
                   std::uint64_t b_all);

}  // namespace psygen::compare
