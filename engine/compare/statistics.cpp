#include "engine/compare/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>

#include "engine/core/assert.hpp"

namespace psygen::compare {
namespace {

constexpr double kSame = 1 - 1e-12;  // tolerates sums of the same values in another order
constexpr double kTailShare = 0.01;
constexpr double kRareShare = 0.015;
constexpr std::size_t kSumWindow = 10, kTailWindow = 3;  // frames
constexpr std::uint32_t kTailLabellings = 4096;
constexpr double kStep = 0.0025, kFarthest = 1.0;  // for the search for the interval
constexpr double kRefused = 0.025;                 // on each side

using Frames = std::vector<double>;

// The two shortest times of each window over the runs of a set.
struct Least {
  Frames first, second;

  explicit Least(std::size_t windows)
      : first(windows, std::numeric_limits<double>::infinity()), second(first) {}
  void add(const Frames& run) {
    for (std::size_t k = 0; k < first.size(); ++k) {
      second[k] = std::min(second[k], std::max(first[k], run[k]));
      first[k] = std::min(first[k], run[k]);
    }
  }
};

struct LeastOfBoth {
  Least a, b;
};

// Bit i of the labelling exchanges the runs of pair i.
LeastOfBoth min_of(const Times& a, const Times& b, std::uint32_t labelling) {
  LeastOfBoth least{Least(a[0].size()), Least(a[0].size())};
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool swapped = (labelling >> i & 1) != 0;
    least.a.add(swapped ? b[i] : a[i]);
    least.b.add(swapped ? a[i] : b[i]);
  }
  return least;
}

// Sums over each `window` consecutive frames of each run; over all frames if there are fewer.
Times windows_of(const Times& runs, std::size_t window) {
  Times sums;
  for (const Frames& run : runs) {
    const std::size_t w = std::min(window, run.size());
    double sum = 0;
    sums.emplace_back();
    for (std::size_t k = 0; k < run.size(); ++k) {
      sum += run[k] - (k >= w ? run[k - w] : 0);
      if (k + 1 >= w) sums.back().push_back(sum);
    }
  }
  return sums;
}

double sum(const Frames& frames) {
  return std::accumulate(frames.begin(), frames.end(), 0.0);
}

double ratio_of(const LeastOfBoth& least) {
  return sum(least.b.first) / sum(least.a.first);
}

// Moves the largest `share` of the values, at least one, to the front, and returns their number.
std::size_t greatest_first(Frames& values, double share) {
  const auto count =
      static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(count - 1),
                           std::greater{});
  return count;
}

double tail_of(const LeastOfBoth& least) {
  const auto& [a, b] = least;
  Frames ratios(a.first.size());
  std::ranges::transform(b.second, a.second, ratios.begin(), std::divides{});
  ratios.resize(greatest_first(ratios, kTailShare));
  return sum(ratios) / static_cast<double>(ratios.size());
}

struct Tails {
  double p_larger = 0, p_smaller = 0;
};

// Counts the labellings with at least, and with at most, the statistic of labelling 0.
template <class Statistic>
Tails over_labellings(std::size_t pairs, const Statistic& statistic) {
  const std::uint32_t count = 1U << pairs;
  const double seen = statistic(0U);
  std::uint32_t larger = 0, smaller = 0;
  for (std::uint32_t labelling = 0; labelling < count; ++labelling) {
    const double value = statistic(labelling);
    larger += value >= seen - std::abs(seen) * (1 - kSame) ? 1U : 0U;
    smaller += value <= seen + std::abs(seen) * (1 - kSame) ? 1U : 0U;
  }
  return {static_cast<double>(larger) / count, static_cast<double>(smaller) / count};
}

// As if B took 1/scale of its time.
Tails ratio_tails(const Times& a, const Times& b, double scale) {
  Times scaled = b;
  for (Frames& run : scaled)
    for (double& ms : run)
      ms /= scale;
  return over_labellings(
      a.size(), [&](std::uint32_t labelling) { return ratio_of(min_of(a, scaled, labelling)); });
}

// Ends of the interval: the scales at which the test rejects the rest.
void find_interval(const Times& a, const Times& b, MinimaTest& test) {
  test.low = test.high = test.ratio;
  double step = 0;
  for (; step < kFarthest && ratio_tails(a, b, test.low).p_larger > kRefused; step += kStep)
    test.low = test.ratio / (1 + step);
  if (step >= kFarthest) test.low = 0;
  for (step = 0; step < kFarthest && ratio_tails(a, b, test.high).p_smaller > kRefused;
       step += kStep)
    test.high = test.ratio * (1 + step);
  if (step >= kFarthest) test.high = std::numeric_limits<double>::infinity();
}

double log_choose(std::uint64_t n, std::uint64_t k) {
  const auto log_factorial = [](std::uint64_t x) {
    return std::lgamma(static_cast<double>(x) + 1);
  };
  return log_factorial(n) - log_factorial(k) - log_factorial(n - k);
}

}  // namespace

double swap_test(std::span<const double> a, std::span<const double> b) {
  PSYGEN_ASSERT(a.size() == b.size() && a.size() <= 2 * kMaxPairs, "pairs");
  return over_labellings(a.size(),
                         [&](std::uint32_t labelling) {
                           double difference = 0;
                           for (std::size_t i = 0; i < a.size(); ++i)
                             difference += (labelling >> i & 1) != 0 ? a[i] - b[i] : b[i] - a[i];
                           return difference;
                         })
      .p_larger;
}

MinimaTest minima_test(const Times& a, const Times& b) {
  PSYGEN_ASSERT(a.size() > 1 && a.size() == b.size() && a.size() <= kMaxPairs, "pairs");
  MinimaTest test;
  const Times sums_a = windows_of(a, kSumWindow), sums_b = windows_of(b, kSumWindow);
  test.ratio = ratio_of(min_of(sums_a, sums_b, 0));
  const Tails tails = ratio_tails(sums_a, sums_b, 1);
  test.p_slower = tails.p_larger;
  test.p_faster = tails.p_smaller;
  find_interval(sums_a, sums_b, test);
  return test;
}

TailTest tail_test(const Times& a, const Times& b) {
  PSYGEN_ASSERT(a.size() > 1 && a.size() == b.size() && a.size() <= 2 * kMaxPairs, "pairs");
  const Times sums_a = windows_of(a, kTailWindow), sums_b = windows_of(b, kTailWindow);
  const double seen = tail_of(min_of(sums_a, sums_b, 0));
  std::mt19937_64 random(1);
  std::uint32_t larger = 1;  // the observed labelling
  for (std::uint32_t i = 1; i < kTailLabellings; ++i) {
    const auto labelling = static_cast<std::uint32_t>(random());
    larger += tail_of(min_of(sums_a, sums_b, labelling)) >= seen * kSame ? 1U : 0U;
  }
  return {seen, static_cast<double>(larger) / kTailLabellings};
}

std::vector<double> rare_frames(const Times& runs) {
  PSYGEN_ASSERT(!runs.empty() && !runs.front().empty(), "frames");
  Frames usual(runs.front().size()), times(runs.size());
  const auto quartile = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 4);
  for (std::size_t k = 0; k < usual.size(); ++k) {
    for (std::size_t i = 0; i < runs.size(); ++i)
      times[i] = runs[i][k];
    std::ranges::nth_element(times, quartile);
    usual[k] = *quartile;
  }
  std::vector<double> rare;
  for (const Frames& run : runs) {
    Frames logarithms(usual.size());
    std::ranges::transform(run, usual, logarithms.begin(),
                           [](double ms, double usually) { return std::log(ms / usually); });
    logarithms.resize(greatest_first(logarithms, kRareShare));
    rare.push_back(sum(logarithms) / static_cast<double>(logarithms.size()));
  }
  return rare;
}

double fisher_more(std::uint64_t a_hits, std::uint64_t a_all, std::uint64_t b_hits,
                   std::uint64_t b_all) {
  PSYGEN_ASSERT(a_hits <= a_all && b_hits <= b_all, "hits must not exceed runs");
  const std::uint64_t hits = a_hits + b_hits;
  const double all = log_choose(a_all + b_all, hits);
  double p = 0;
  for (std::uint64_t k = b_hits; k <= std::min(hits, b_all); ++k) {
    if (hits - k > a_all) continue;
    p += std::exp(log_choose(b_all, k) + log_choose(a_all, hits - k) - all);
  }
  return std::min(p, 1.0);
}

std::vector<double> mann_whitney_tail(std::size_t n, std::size_t m, std::size_t most) {
  PSYGEN_ASSERT(n > 0 && m > 0 && most <= n * m, "values");
  // counts[j][u]: orders of i values of A and j of B with u such pairs. The last value of an order
  // is one of B, above all i, or one of A.
  std::vector<std::vector<double>> counts(m + 1, std::vector<double>(most + 1, 0.0));
  for (auto& of_j : counts)
    of_j[0] = 1;
  for (std::size_t i = 1; i <= n; ++i)
    for (std::size_t j = 1; j <= m; ++j)
      for (std::size_t u = i; u <= most; ++u)
        counts[j][u] += counts[j - 1][u - i];
  std::vector<double>& tail = counts.back();
  const double all = std::exp(log_choose(n + m, n));
  double sum = 0;
  for (double& each : tail)
    each = (sum += each) / all;
  return std::move(tail);
}

double median(std::span<const double> values) {
  PSYGEN_ASSERT(!values.empty(), "a median needs a value");
  std::vector<double> sorted(values.begin(), values.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  if (sorted.size() % 2 == 1) return *middle;
  return (*std::max_element(sorted.begin(), middle) + *middle) / 2;
}

double pairs_above(std::span<const double> a, std::span<const double> b) {
  double above = 0;
  for (const double x : a)
    for (const double y : b)
      above += y > x ? 1 : y == x ? 0.5 : 0;
  return above;
}

double mann_whitney(std::span<const double> a, std::span<const double> b) {
  PSYGEN_ASSERT(!a.empty() && !b.empty() && std::max(a.size(), b.size()) <= 100, "values");
  const double above = pairs_above(a, b);
  const auto pairs = static_cast<double>(a.size() * b.size());
  const auto seen = static_cast<std::size_t>(std::ceil(std::min(above, pairs - above)));
  return std::min(1.0, 2 * mann_whitney_tail(a.size(), b.size(), seen).back());
}

}  // namespace psygen::compare
