#include "engine/synthesis/cost_correction.hpp"

#include <algorithm>
#include <cmath>

namespace psygen::synthesis {
namespace {
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
