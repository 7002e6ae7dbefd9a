// Exact tests that compare two sets of runs. Runs come in pairs, one of A and one of B shortly
// after each other, in random order. If A and B are the same, exchanging the two runs of a pair
// changes nothing: all 2^n labellings are equally likely, and p is the fraction of labellings at
// least as extreme as the observed one (Fisher's randomisation test). Assumes nothing about the
// noise. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace psygen::compare {

// Number of pairs that can be judged: with fewer no p is below 0.01, with more there are too many
// labellings.
inline constexpr std::size_t kFewestPairs = 7, kMaxPairs = 12;

// One value of each run. Returns p for the sum of b − a being at least the observed sum. Requires
// equal sizes, at most 2 kMaxPairs. O(n 2^n).
double swap_test(std::span<const double> a, std::span<const double> b);

// Frame times of runs: [run][frame], all of one length of at least 1, above 0. Frame k does the
// same work in every run, so the minimum over a set's runs is that work without interference. With
// frames in flight, a frame after a delayed one waits less, so minima are taken over windows: sums
// over 10 consecutive frames.
using Times = std::vector<std::vector<double>>;

struct MinimaTest {
  double ratio = 1;     // sum of the minima of B over that of A
  double p_slower = 1;  // probability of this ratio or a larger one by chance
  double p_faster = 1;  // probability of this ratio or a smaller one by chance
  // Interval of the ratio: values that a two-sided test at 5 % does not reject.
  double low = 0, high = 0;
};
// Requires equal sizes, 2 to kMaxPairs. O(2^n n frames), about 100 times.
MinimaTest minima_test(const Times& a, const Times& b);

// Slow frames that the sum hides: in windows of 3 frames, the ratio of B's to A's second shortest
// time over a set's runs; the mean over the 1 % of windows where it is largest.
struct TailTest {
  double ratio = 1;
  double p = 1;  // probability of this ratio or a larger one by chance; from 4096 random labellings
};
// Requires equal sizes, 2 to 2 kMaxPairs.
TailTest tail_test(const Times& a, const Times& b);

// For each run, the slowness of its rare frames: the mean logarithm of the largest 1.5 % of the
// ratios of a frame's time to its lower quartile over all runs. Half of the runs may be slow in the
// same frame.
std::vector<double> rare_frames(const Times& runs);

// Fisher's exact test: `a_hits` of `a_all` runs of A have a property, and likewise for B. Returns p
// for B having at least this many if both are the same. Requires hits <= all.
double fisher_more(std::uint64_t a_hits, std::uint64_t a_all, std::uint64_t b_hits,
                   std::uint64_t b_all);

// Exact distribution of Mann and Whitney's U for sets of n and m values without ties: element u is
// the probability that at most u of the n m pairs have the larger value in B, up to `most`.
// Requires n and m from 1 and most <= n m. O(n m most).
std::vector<double> mann_whitney_tail(std::size_t n, std::size_t m, std::size_t most);

// Exact two-sided test of Mann and Whitney for values that are no pairs: p of values of one set
// standing as often above those of the other. Ties count against a difference. Requires 1 to 100
// values each. O(n² m²) for n and m values.
double mann_whitney(std::span<const double> a, std::span<const double> b);

// Median of distances to the median, to standard deviation of a normal distribution.
inline constexpr double kRobust = 1.4826;
// The median; requires a value. O(n).
double median(std::span<const double> values);
// Number of pairs with the larger value in b, ties half. O(n m).
double pairs_above(std::span<const double> a, std::span<const double> b);

}  // namespace psygen::compare
