#include "engine/compare/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "engine/core/assert.hpp"

namespace psygen::compare {
namespace {

constexpr double kSame = 1 - 1e-12;  // sums of the same values in another order
constexpr double kTailShare = 0.01;
constexpr double kStep = 0.0025, kFarthest = 1.0;  // of the search for the interval
constexpr double kRefused = 0.025;                 // on either side

using Frames = std::vector<double>;

void lower(Frames& minima, const Frames& run) {
  for (std::size_t k = 0; k < minima.size(); ++k)
    minima[k] = std::min(minima[k], run[k]);
}

struct Minima {
  Frames a, b;
};

// Bit i of the labelling exchanges the runs of pair i.
Minima minima_of(const Times& a, const Times& b, std::uint32_t labelling) {
  const Frames none(a[0].size(), std::numeric_limits<double>::infinity());
  Minima minima{none, none};
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool swapped = (labelling >> i & 1) != 0;
    lower(minima.a, swapped ? b[i] : a[i]);
    lower(minima.b, swapped ? a[i] : b[i]);
  }
  return minima;
}

double sum(const Frames& frames) {
  return std::accumulate(frames.begin(), frames.end(), 0.0);
}

double ratio_of(const Minima& minima) {
  return sum(minima.b) / sum(minima.a);
}

double tail_of(const Minima& minima) {
  Frames ratios(minima.a.size());
  std::ranges::transform(minima.b, minima.a, ratios.begin(), std::divides{});
  const auto count =
      static_cast<std::size_t>(std::ceil(kTailShare * static_cast<double>(ratios.size())));
  std::ranges::nth_element(ratios, ratios.begin() + static_cast<std::ptrdiff_t>(count - 1),
                           std::greater{});
  ratios.resize(count);
  return sum(ratios) / static_cast<double>(count);
}

struct Tails {
  double p_larger = 0, p_smaller = 0;
};

// How often labellings give at least, and at most, what labelling 0 gives.
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
      a.size(), [&](std::uint32_t labelling) { return ratio_of(minima_of(a, scaled, labelling)); });
}

// The ends of the interval: scales at which what is left is refused.
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
  PSYGEN_ASSERT(a.size() == b.size() && a.size() <= kMostPairs, "pairs");
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
  PSYGEN_ASSERT(!a.empty() && a.size() == b.size() && a.size() <= kMostPairs, "pairs");
  MinimaTest test;
  const Minima seen = minima_of(a, b, 0);
  test.ratio = ratio_of(seen);
  test.tail_ratio = tail_of(seen);
  const Tails tails = ratio_tails(a, b, 1);
  test.p_slower = tails.p_larger;
  test.p_faster = tails.p_smaller;
  test.p_tail = over_labellings(a.size(), [&](std::uint32_t labelling) {
                  return tail_of(minima_of(a, b, labelling));
                }).p_larger;
  find_interval(a, b, test);
  return test;
}

double fisher_more(std::uint64_t a_hits, std::uint64_t a_all, std::uint64_t b_hits,
                   std::uint64_t b_all) {
  PSYGEN_ASSERT(a_hits <= a_all && b_hits <= b_all, "more hits than runs");
  const std::uint64_t hits = a_hits + b_hits;
  const double all = log_choose(a_all + b_all, hits);
  double p = 0;
  for (std::uint64_t k = b_hits; k <= std::min(hits, b_all); ++k) {
    if (hits - k > a_all) continue;
    p += std::exp(log_choose(b_all, k) + log_choose(a_all, hits - k) - all);
  }
  return std::min(p, 1.0);
}

}  // namespace psygen::compare
