// Verdict on one figure at a known place of its history: the runs of a revision against the runs
// before it. A change for the worse needs two witnesses, the figure and its ratio to a reference
// load that ran beside it, and is confirmed by a second look at fresh runs if there are any. No
// random numbers. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/history/figure_rules.hpp"
#include "engine/history/ranks.hpp"

namespace psygen::history {

enum class Outcome : std::uint8_t {
  kSame,
  kWorse,
  kBetter,
  kUndecided,
  kDifferentWork,  // the runs made another number of models
  kTooFew,
};
std::string_view name_of(Outcome outcome);  // "same", "worse", …

// A value of a figure, with the seconds of the reference load beside it.
struct Observation {
  double value = 0;                 // finite; above 0 for figures on a scale of logarithms
  std::optional<double> reference;  // above 0
  std::optional<double> work;       // models made
};

// Runs before that are compared at most, and runs after for a second look.
inline constexpr std::size_t kMaxBefore = 40, kSecondLook = 2 * kFewestRuns;
// Relative difference of the medians of the models made that counts as different work.
inline constexpr double kSameWork = 0.02;

// Result of the test of one witness.
struct Witness {
  double p = 1, effect = 0;  // on the scale of the rule
  double spread = 0;         // robust standard deviation of a run
  int found = 0;             // 1: a change upward, −1: downward, 0: none
};

struct GateVerdict {
  Outcome outcome = Outcome::kTooFew;
  std::string reason;                 // a sentence
  std::size_t before = 0, after = 0;  // runs that were compared
  Witness figure;
  std::optional<Witness> ratio;  // none: no reference load
  double unseen = 0;             // smaller changes would stay unseen, on the scale of the rule
  int looks = 1;
};

// The figure, or its ratio to the reference load, on the scale of the rule. Observations without a
// reference have no ratio.
std::vector<double> scaled(const FigureRule& rule, std::span<const Observation> runs, bool ratio);

// Judges the observations `after` against those `before`, both in the order of adding. Of `before`,
// at most the last kMaxBefore count, from the last change in them on. `figures` is the number of
// figures that are judged at once: with 20 runs before, all together have 1 % of false alarms.
GateVerdict judge(const FigureRule& rule, std::span<const Observation> before,
                  std::span<const Observation> after, std::size_t figures, RankTails& tails);

// The two-sided test of one witness on the scale of the rule.
Witness test_step(std::span<const double> before, std::span<const double> after, double floor,
                  double significant, RankTails& tails);

}  // namespace psygen::history
