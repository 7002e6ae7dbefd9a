#include "engine/synthesis/cost_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace psygen::synthesis {
namespace {

constexpr std::size_t kTerms = 4;
constexpr int kReweightings = 8;
// Errors up to this size count by their square, larger ones by their size (Huber).
constexpr double kTolerance = 0.05;
// A further term must reduce the error to this fraction.
constexpr double kWorth = 0.95;
// A correction must reduce the error to less than this fraction: any correction explains a little
// by chance.
constexpr double kWorthBending = 0.7;

using Row = std::array<double, kTerms>;  // the terms divided by the measured seconds
using Coefficients = std::array<double, kTerms>;

Row row_of(const Measurement& m) {
  return {1 / m.seconds, m.work.operations / m.seconds, m.work.triangles / m.seconds,
          m.work.steps / m.seconds};
}

double residual(const Row& row, const Coefficients& c) {
  double sum = -1;
  for (std::size_t i = 0; i < kTerms; ++i)
    sum += row[i] * c[i];
  return sum;
}

// Gaussian elimination without row exchanges over the terms of `subset` (one bit each). Returns
// nullopt if the terms are linearly dependent.
std::optional<Coefficients> solve(std::span<const Row> rows, std::span<const double> weights,
                                  unsigned subset) {
  std::array<std::array<double, kTerms + 1>, kTerms> a{};
  for (std::size_t i = 0; i < kTerms; ++i) {
    if ((subset >> i & 1) == 0) {
      a[i][i] = 1;
      continue;
    }
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t j = 0; j < kTerms; ++j)
        if ((subset >> j & 1) != 0) a[i][j] += weights[r] * rows[r][i] * rows[r][j];
      a[i][kTerms] += weights[r] * rows[r][i];
    }
  }
  // Scales all terms to one size, so that a small pivot means dependent terms.
  std::array<double, kTerms> scale{};
  for (std::size_t i = 0; i < kTerms; ++i)
    scale[i] = a[i][i] > 0 ? 1 / std::sqrt(a[i][i]) : 0;
  for (std::size_t i = 0; i < kTerms; ++i) {
    for (std::size_t j = 0; j < kTerms; ++j)
      a[i][j] *= scale[i] * scale[j];
    a[i][kTerms] *= scale[i];
  }
  for (std::size_t i = 0; i < kTerms; ++i) {
    // Symmetric and positive: needs no exchange.
    if (!(std::abs(a[i][i]) > 1e-9)) return std::nullopt;
    for (std::size_t k = i + 1; k < kTerms; ++k) {
      const double factor = a[k][i] / a[i][i];
      for (std::size_t j = i; j <= kTerms; ++j)
        a[k][j] -= factor * a[i][j];
    }
  }
  Coefficients c{};
  for (std::size_t i = kTerms; i-- > 0;) {
    c[i] = a[i][kTerms];
    for (std::size_t j = i + 1; j < kTerms; ++j)
      c[i] -= a[i][j] * c[j];
    c[i] /= a[i][i];
  }
  for (std::size_t i = 0; i < kTerms; ++i)
    c[i] = (subset >> i & 1) != 0 ? c[i] * scale[i] : 0;
  return c;
}

struct Solution {
  Coefficients coefficients{};
  double error = std::numeric_limits<double>::infinity();
};

Solution robust_solution(std::span<const Row> rows, unsigned subset) {
  std::vector<double> weights(rows.size(), 1.0);
  Solution best;
  for (int i = 0; i < kReweightings; ++i) {
    const auto c = solve(rows, weights, subset);
    if (!c || *std::min_element(c->begin(), c->end()) < 0) return best;
    double error = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const double e = std::abs(residual(rows[r], *c));
      weights[r] = e <= kTolerance ? 1 : kTolerance / e;
      error += e <= kTolerance ? e * e / 2 : kTolerance * (e - kTolerance / 2);
    }
    best = {*c, error};
  }
  return best;
}

double log2_size(const Work& work) {
  return std::log2(1 + std::max(work.steps, 0.0));
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double mean_error(const CostFit& fit, std::span<const Measurement> measurements) {
  double sum = 0;
  for (const Measurement& m : measurements)
    sum += std::min(std::abs(fit.seconds(m.work) / m.seconds - 1), 1.0);
  return sum / static_cast<double>(std::max<std::size_t>(measurements.size(), 1));
}

// Bends `fit` through the medians of groups of measurements of similar size.
void add_correction(CostFit& fit, std::span<const Measurement> measurements) {
  std::vector<CostFit::Knot> ratios;
  for (const Measurement& m : measurements) {
    if (m.seconds > 0) ratios.push_back({log2_size(m.work), m.seconds / fit.line_seconds(m.work)});
  }
  if (ratios.size() < kMinForKnots) return;
  std::stable_sort(
      ratios.begin(), ratios.end(),
      [](const CostFit::Knot& a, const CostFit::Knot& b) { return a.log2_size < b.log2_size; });
  for (std::size_t k = 0; k < CostFit::kMaxKnots; ++k) {
    std::vector<double> sizes, factors;
    for (std::size_t i = k * ratios.size() / CostFit::kMaxKnots;
         i < (k + 1) * ratios.size() / CostFit::kMaxKnots; ++i) {
      sizes.push_back(ratios[i].log2_size);
      factors.push_back(ratios[i].factor);
    }
    const CostFit::Knot knot{median(sizes), median(factors)};
    // Two groups of one size define no slope.
    if (fit.knot_count > 0 && knot.log2_size - fit.knots[fit.knot_count - 1].log2_size < 1e-3)
      continue;
    fit.knots[fit.knot_count++] = knot;
  }
}

constexpr double kMinRate = 0.05;  // weight of one observation never falls below this
// An observation counts as off by at most kLargestSurprise, and as faster than a guess by at most
// kLargestDoubt: chance can make a request slow, but not fast.
constexpr double kLargestSurprise = 2.0, kLargestDoubt = 1000.0;
// Step sizes towards the observed cost of cold caches. The first steps are some microseconds
// whatever the observation says, because the very first requests of a thread take milliseconds.
constexpr double kFirstStep_s = 20e-6, kMinStep_s = 1e-6;
constexpr std::uint32_t kFirst = 4;

double rate_of(std::uint32_t count) {
  return std::max(kMinRate, 1.0 / (1.0 + count));
}

}  // namespace

double CostFit::correction(const Work& work) const {
  if (knot_count == 0) return 1;
  if (knot_count == 1) return knots[0].factor;
  const double size = log2_size(work);
  std::size_t k = 1;  // end of the segment; the outer segments extend beyond their knots
  while (k + 1 < knot_count && size > knots[k].log2_size)
    ++k;
  const Knot &a = knots[k - 1], &b = knots[k];
  const double share = (size - a.log2_size) / (b.log2_size - a.log2_size);
  const double factor = a.factor + share * (b.factor - a.factor);
  return std::clamp(factor, std::min(a.factor, b.factor) / 2, std::max(a.factor, b.factor) * 2);
}

CostFit fit_cost(std::span<const Measurement> measurements) {
  std::vector<Row> rows;
  for (const Measurement& m : measurements) {
    if (m.seconds > 0) rows.push_back(row_of(m));
  }
  // Subsets of one term, of two, and so on; the formula first.
  constexpr std::array<unsigned, 15> kSubsets{0b0010, 0b0100, 0b1000, 0b0001, 0b0011,
                                              0b0101, 0b1001, 0b0110, 0b1010, 0b1100,
                                              0b0111, 0b1011, 0b1101, 0b1110, 0b1111};
  const std::size_t tried = rows.size() < kMinForTerms ? 1 : kSubsets.size();
  // Errors below this are rounding errors of an exact fit.
  const double nothing = 1e-12 * static_cast<double>(rows.size());
  Solution best;
  for (std::size_t s = 0; s < tried; ++s) {
    const Solution solution = robust_solution(rows, kSubsets[s]);
    if (solution.error < best.error * kWorth - nothing) best = solution;
  }
  CostFit fit;
  fit.fixed_s = best.coefficients[0];
  fit.per_operation_s = best.coefficients[1];
  fit.per_triangle_s = best.coefficients[2];
  fit.per_step_s = best.coefficients[3];
  CostFit bent = fit;
  add_correction(bent, measurements);
  const bool better =
      mean_error(bent, measurements) < kWorthBending * mean_error(fit, measurements);
  return better ? bent : fit;
}

FormulaFit fit_formula(std::span<const Measurement> measurements) {
  const auto count = static_cast<double>(measurements.size());
  double xx = 0, xt = 0, sum_x = 0, sum_t = 0;
  for (const Measurement& m : measurements) {
    xx += m.work.operations * m.work.operations;
    xt += m.work.operations * m.seconds;
    sum_x += m.work.operations;
    sum_t += m.seconds;
  }
  if (!(xx > 0)) return {};
  const auto r_squared = [&](double fixed, double slope) {
    double unexplained = 0, variance = 0;
    for (const Measurement& m : measurements) {
      const double error = m.seconds - fixed - slope * m.work.operations;
      const double deviation = m.seconds - sum_t / count;
      unexplained += error * error;
      variance += deviation * deviation;
    }
    return variance > 0 ? 1 - unexplained / variance : 1;
  };
  FormulaFit fit;
  fit.seconds_per_operation = xt / xx;
  fit.r_squared = r_squared(0, fit.seconds_per_operation);
  const double spread = xx - sum_x * sum_x / count;
  if (spread > 1e-12 * xx) fit.seconds_per_operation_above = (xt - sum_x * sum_t / count) / spread;
  fit.fixed_s = (sum_t - fit.seconds_per_operation_above * sum_x) / count;
  fit.r_squared_above = std::max(r_squared(fit.fixed_s, fit.seconds_per_operation_above), 0.0);
  return fit;
}

void RunningEstimate::observe(double seconds, double beside_s) {
  ++count_;
  const double limit =
      std::max(count_ < kFirst ? kFirstStep_s : kMinStep_s, 0.5 * (beside_s + value_));
  const double off = std::clamp(seconds - value_, -limit, limit);
  value_ = std::max(0.0, value_ + rate_of(count_) * off);
}

void CostCorrection::follow(double warm_s, double seconds) {
  const double fastest = count_ < kTrusted ? kLargestDoubt : kLargestSurprise;
  const double surprise = std::clamp(seconds / warm_s, 1 / fastest, kLargestSurprise);
  factor_ *= std::pow(surprise, rate_of(count_));
  ++count_;
}

void CostCorrection::observe(double curve_s, Warmth warmth, double seconds, ColdSeconds& shared) {
  const double warm_s = factor_ * curve_s;
  if (warmth == Warmth::kWarm) return follow(warm_s, seconds);
  // Cold caches only add time. Some levels are never requested warm, so without this a curve that
  // is too high would stay so.
  if (seconds < warm_s) follow(warm_s, seconds);
  RunningEstimate& own = cold_.of(warmth);
  RunningEstimate& all = shared.of(warmth);
  if (own.count() == 0) own.guess(all.value());
  own.observe(seconds - warm_s, warm_s);
  all.observe(seconds - warm_s, warm_s);
}

double CostCorrection::seconds(double curve_s, Warmth warmth, const ColdSeconds& shared) const {
  const double warm_s = factor_ * curve_s;
  if (warmth == Warmth::kWarm) return warm_s;
  const RunningEstimate& own = cold_.of(warmth);
  return warm_s + (own.count() >= ColdSeconds::kEnough ? own.value() : shared.of(warmth).value());
}

}  // namespace psygen::synthesis
