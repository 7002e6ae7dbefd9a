#include "engine/history/scan.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace psygen::history {
namespace {

using Values = std::span<const double>;
constexpr std::size_t kWindow = 60, kStep = 30;

// The best place of a change in a segment.
struct Split {
  double p = 2;
  std::size_t at = 0;
  double effect = 0;
};

double step_at(Values x, std::size_t at) {
  return median(x.subspan(at)) - median(x.first(at));
}

// Requires 2 kFewestRuns values. Of equal p, the larger effect counts.
Split best_split(Values x, RankTails& tails) {
  const std::vector<double> ranks = mid_ranks(x);
  Split best;
  double sum = 0;  // of the ranks before t; 0 over all runs
  for (std::size_t t = 1; t + kFewestRuns <= x.size(); ++t) {
    sum += ranks[t - 1];
    if (t < kFewestRuns) continue;
    const std::size_t m = x.size() - t;
    const double above = static_cast<double>(t * m) / 2 - sum;
    const double p = tails.p(t, m, above);
    if (p > best.p) continue;
    const double effect = step_at(x, t);
    if (p < best.p || std::abs(effect) > std::abs(best.effect)) best = {p, t, effect};
  }
  return best;
}

double places(std::size_t runs) {
  return static_cast<double>(runs - 2 * kFewestRuns + 1);
}

// Adds the places at which ranks alone say that the segment changes.
void add_candidates(Values x, std::size_t begin, std::size_t end, RankTails& tails,
                    std::vector<std::size_t>& ends) {
  if (end - begin < 2 * kFewestRuns) return;
  const Split split = best_split(x.subspan(begin, end - begin), tails);
  if (split.p * places(end - begin) > kSignificant) return;
  add_candidates(x, begin, begin + split.at, tails, ends);
  ends.push_back(begin + split.at);
  add_candidates(x, begin + split.at, end, tails, ends);
}

// Values less the medians of their segments.
std::vector<double> residuals(Values x, const std::vector<std::size_t>& ends) {
  std::vector<double> result;
  for (std::size_t k = 1; k < ends.size(); ++k) {
    const Values segment = x.subspan(ends[k - 1], ends[k] - ends[k - 1]);
    const double middle = median(segment);
    for (const double value : segment)
      result.push_back(value - middle);
  }
  return result;
}

// A candidate, tested between its neighbours. Ordered from strong to weak.
struct Tested {
  bool fails = false;
  double z = 0;
  std::size_t index = 0, at = 0;
  bool operator<(const Tested& other) const {
    return std::tie(fails, z, index) < std::tie(other.fails, other.z, other.index);
  }
};

std::vector<Tested> test(Values x, const std::vector<std::size_t>& ends, double floor,
                         RankTails& tails) {
  std::vector<double> rest = residuals(x, ends);
  const double correlation = rank_correlation(rest, 0.5 / std::sqrt(static_cast<double>(x.size())));
  for (double& each : rest)
    each = std::abs(each);
  std::vector<Tested> tested;
  for (std::size_t k = 1; k + 1 < ends.size(); ++k) {
    const std::size_t begin = ends[k - 1], runs = ends[k + 1] - begin;
    const Split split = best_split(x.subspan(begin, runs), tails);
    const double z = corrected(z_of(split.p), correlation);
    const double spread = kRobust * median(Values(rest).subspan(begin, runs));
    const bool fails = p_of(z) * places(runs) > kSignificant ||
                       std::abs(split.effect) < std::max(floor, kMinSpreads * spread);
    tested.push_back({fails, z, k, begin + split.at});
  }
  return tested;
}

// The places of the changes of at most kWindow runs.
std::vector<std::size_t> changes_in(Values x, double floor, RankTails& tails) {
  std::vector<std::size_t> ends{0};
  add_candidates(x, 0, x.size(), tails, ends);
  ends.push_back(x.size());
  while (ends.size() > 2) {
    const std::vector<Tested> tested = test(x, ends, floor, tails);
    const Tested weakest = *std::ranges::max_element(tested, std::less<>());
    if (weakest.fails) {
      ends.erase(ends.begin() + static_cast<std::ptrdiff_t>(weakest.index));
      continue;
    }
    std::vector<std::size_t> moved{0};
    for (const Tested& each : tested)
      moved.push_back(each.at);
    moved.push_back(x.size());
    const auto too_near = [](std::size_t a, std::size_t b) { return b < a + kFewestRuns; };
    if (std::ranges::adjacent_find(moved, too_near) == moved.end()) ends = std::move(moved);
    break;
  }
  return {ends.begin() + 1, ends.end() - 1};
}

// Places of all windows; two windows may place one change a few runs apart.
std::vector<std::size_t> places_of(Values x, double floor, RankTails& tails) {
  if (x.size() <= kWindow) return changes_in(x, floor, tails);
  std::vector<std::size_t> found;
  for (std::size_t begin = 0;; begin += kStep) {
    const std::size_t runs = std::min(kWindow, x.size() - begin);
    for (const std::size_t at : changes_in(x.subspan(begin, runs), floor, tails))
      found.push_back(begin + at);
    if (begin + runs == x.size()) break;
  }
  std::ranges::sort(found);
  const auto same = [](std::size_t a, std::size_t b) { return b < a + kFewestRuns; };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return found;
}

}  // namespace

std::vector<ChangePoint> change_points(Values values, double floor, RankTails& tails) {
  if (values.size() < 2 * kFewestRuns) return {};
  std::vector<std::size_t> ends = places_of(values, floor, tails);
  ends.insert(ends.begin(), 0);
  ends.push_back(values.size());
  std::vector<ChangePoint> changes;
  for (std::size_t k = 1; k + 1 < ends.size(); ++k) {
    const std::size_t begin = ends[k - 1];
    changes.push_back(
        {ends[k], step_at(values.subspan(begin, ends[k + 1] - begin), ends[k] - begin)});
  }
  return changes;
}

}  // namespace psygen::history
