// The work of a synthesis and the fitted cost curve: a line, seconds = fixed + per_operation ·
// operations + per_triangle · triangles + per_step · steps, with no negative coefficient, times a
// correction over steps that bends the line where time is not proportional to work. Operations
// follow the type's asymptotic formula (paper, section 5.2). Triangles and steps are exact and
// include the effect of the seed: the size of the level, and the number of growth steps behind it
// (ModelType::steps). Pure.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace psygen::synthesis {

// Work of one synthesis.
struct Work {
  double operations = 1;
  double triangles = 0;  // of the level
  double steps = 0;      // as counted by the type, or else the triangles of level 0
  friend bool operator==(const Work&, const Work&) = default;
};

// The line and its correction. Default: zero seconds.
struct CostFit {
  static constexpr std::size_t kMaxKnots = 8;
  struct Knot {
    double log2_size = 0;  // of 1 + steps
    double factor = 1;
  };
  double fixed_s = 0;
  double per_operation_s = 0;
  double per_triangle_s = 0;
  double per_step_s = 0;
  std::size_t knot_count = 0;           // 0: no correction
  std::array<Knot, kMaxKnots> knots{};  // ascending; linear between and beyond them

  // Seconds of one core: by the line, the factor over steps, and their product.
  double line_seconds(const Work& work) const {
    return fixed_s + per_operation_s * work.operations + per_triangle_s * work.triangles +
           per_step_s * work.steps;
  }
  double correction(const Work& work) const;
  double seconds(const Work& work) const { return line_seconds(work) * correction(work); }
};

// Duration of one synthesis.
struct Measurement {
  Work work;
  double seconds = 0;  // above 0
};

// Fits the line that minimises the squares of the relative error |fit − measured| / measured.
// Outliers (another program was running) count less. Prefers fewer terms if they fit as well, and
// no correction if it explains little. Fits only the formula below kMinForTerms measurements, and a
// correction from kMinForKnots on. Zero without measurements.
inline constexpr std::size_t kMinForTerms = 5, kMinForKnots = 16;
CostFit fit_cost(std::span<const Measurement> measurements);

// seconds = c · operations by least squares of the seconds, as in the paper's Figure 9, with the
// fraction of the variance that it explains. The fraction is below 0 if a constant explains more.
struct FormulaFit {
  double seconds_per_operation = 0;  // c
  double r_squared = 0;              // 1 for fewer than two different times
  // With a constant part added: seconds = a + c · operations.
  double fixed_s = 0, seconds_per_operation_above = 0;
  double r_squared_above = 0;  // in [0, 1]
};
FormulaFit fit_formula(std::span<const Measurement> measurements);

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

// Correction of the curve, learned from the finished requests of one level of a type: a factor, and
// the time that cold caches add. Calibration repeats a synthesis until all its data is cached. A
// modeler that slept finds cold caches and needs up to ten times as long for a small mesh. Uses
// medians instead of means, because some of a hundred requests are interrupted. O(1).
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
