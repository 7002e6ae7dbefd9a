#include "engine/history/ranks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "engine/compare/statistics.hpp"
#include "engine/core/assert.hpp"

namespace psygen::history {

double RankTails::p(std::size_t n, std::size_t m, double above) {
  const auto pairs = static_cast<double>(n * m);
  const auto u = static_cast<std::size_t>(std::ceil(std::min(above, pairs - above)));
  auto [found, is_new] = tails_.try_emplace(std::minmax(n, m));
  if (is_new) found->second = compare::mann_whitney_tail(n, m, (n * m + 1) / 2);
  return std::min(1.0, 2 * found->second[u]);
}

std::vector<double> mid_ranks(std::span<const double> values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
  std::vector<double> ranks(values.size());
  for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
    while (end < order.size() && values[order[end]] == values[order[first]])
      ++end;
    const double rank = (static_cast<double>(first + end) - static_cast<double>(order.size())) / 2;
    for (std::size_t i = first; i < end; ++i)
      ranks[order[i]] = rank;
  }
  return ranks;
}

double rank_correlation(std::span<const double> residuals, double margin) {
  constexpr std::size_t kFewest = 20;
  if (residuals.size() < kFewest) return 0;
  const std::vector<double> ranks = mid_ranks(residuals);
  const double squares = std::inner_product(ranks.begin(), ranks.end(), ranks.begin(), 0.0);
  if (squares == 0) return 0;
  const double products = std::inner_product(ranks.begin() + 1, ranks.end(), ranks.begin(), 0.0);
  return std::clamp(products / squares - margin, 0.0, 0.8);
}

double p_of(double z) {
  return std::erfc(-z / std::numbers::sqrt2);
}

double z_of(double p) {
  constexpr double kMinP = 1e-15;
  const double wanted = std::max(p, kMinP);
  double low = -10, high = 0;  // p_of() rises with z
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (p_of(middle) < wanted ? low : high) = middle;
  }
  return high;
}

double corrected(double z, double correlation) {
  return z / std::sqrt((1 + correlation) / (1 - correlation));
}

}  // namespace psygen::history
