// Learns a correction to the calibrated cost curve of one LOD from finished requests: a factor on
// the curve, and the time that cold caches add. Calibration repeats a synthesis until all its data
// is cached. A modeler that slept finds cold caches and needs up to ten times as long for a small
// mesh. Uses medians instead of means, because some of a hundred requests are interrupted. Pure;
// O(1).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace psygen::synthesis {

// State of a modeler's caches when it claims a request.
enum class Warmth : std::uint8_t {
  kWarm,        // has run the same code since it slept
  kCold,        // has run other code
  kAfterSleep,  // has just slept
};
inline constexpr std::size_t kWarmths = 3;

// Predicted cost of a request before it is known which modeler claims it, and when.
struct RequestCost {
  std::array<double, kWarmths> seconds{};  // of one core, by warmth
  std::size_t code = 0;                    // CostModel::code_of
  // Seconds of one core with warm caches, and with caches of the given warmth.
  double warm_s() const { return seconds[0]; }
  double of(Warmth warmth) const { return seconds[static_cast<std::size_t>(warmth)]; }
};

// Estimate of a duration that follows the median of its observations in steps of bounded size.
class RunningEstimate {
 public:
  // `beside_s`: the known part of the total that this estimate is added to. A step is at most half
  // of the total.
  void observe(double seconds, double beside_s);
  // Initialises the estimate, for example from another LOD.
  void guess(double seconds) { value_ = seconds; }
  double value() const { return value_; }  // never below 0
  std::uint32_t count() const { return count_; }

 private:
  double value_ = 0;
  std::uint32_t count_ = 0;
};

// Time that cold requests add, of one level or of all types with the same code.
class ColdSeconds {
 public:
  static constexpr std::uint32_t kEnough = 3;  // observations after which the estimate is trusted
  // Time that a request of this warmth adds to a warm one.
  const RunningEstimate& of(Warmth warmth) const {
    return added_[static_cast<std::size_t>(warmth)];
  }
  RunningEstimate& of(Warmth warmth) { return added_[static_cast<std::size_t>(warmth)]; }

 private:
  std::array<RunningEstimate, kWarmths> added_;  // unused for kWarm
};

// Correction learned from the finished requests of one level of a type.
class CostCorrection {
 public:
  // Marks the curve as measured on this machine: a single observation then has little weight.
  void trust_curve() { count_ = kTrusted; }
  // Factor on the curve's prediction; 1 before the first observation.
  double factor() const { return factor_; }

  // Records a request that took `seconds` where the curve predicts `curve_s`, both above 0.
  // `shared` holds the estimates of all levels with the same code. A cold request that is faster
  // than a warm prediction lowers the factor too.
  void observe(double curve_s, Warmth warmth, double seconds, ColdSeconds& shared);
  // Predicted seconds of a request for which the curve predicts `curve_s`.
  double seconds(double curve_s, Warmth warmth, const ColdSeconds& shared) const;

 private:
  void follow(double warm_s, double seconds);

  static constexpr std::uint32_t kTrusted = 10;
  double factor_ = 1;
  std::uint32_t count_ = 1;  // of observations, for the size of steps
  ColdSeconds cold_;
};

}  // namespace psygen::synthesis
