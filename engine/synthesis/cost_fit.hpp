// What a synthesis has to do, and the curve through what doing it took: a line, seconds = fixed +
// per_operation · operations + per_triangle · triangles + per_step · steps with no coefficient
// below zero, times a correction over steps that bends it where work does not grow in proportion.
// Operations are the type's asymptotic formula (paper, section 5.2); triangles and steps are exact,
// and know what the random numbers of a seed make of the parameters: the size of the level, and
// what it is grown from (ModelType::steps). Pure.
#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace psygen::synthesis {

// What one synthesis has to do.
struct Work {
  double operations = 1;
  double triangles = 0;  // of the level
  double steps = 0;      // as the type counts them, or else the triangles of level 0
  friend bool operator==(const Work&, const Work&) = default;
};

// The line and its correction. Default: everything takes no time.
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
  std::size_t knot_count = 0;           // 0: the line as it is
  std::array<Knot, kMaxKnots> knots{};  // ascending; linear between them and on

  // Seconds of one core: by the line, the factor over steps, and both together.
  double line_seconds(const Work& work) const {
    return fixed_s + per_operation_s * work.operations + per_triangle_s * work.triangles +
           per_step_s * work.steps;
  }
  double correction(const Work& work) const;
  double seconds(const Work& work) const { return line_seconds(work) * correction(work); }
};

// How long one synthesis took.
struct Measurement {
  Work work;
  double seconds = 0;  // above 0
};

// The best line by squares of the relative error |fit − measured| / measured, with the measurements
// that are far off it (something else ran meanwhile) counting less. Prefers fewer terms where they
// do as well, and no correction where it explains little. Only the formula where there are fewer
// than kMinForTerms measurements, a correction from kMinForKnots on. Zero for none.
inline constexpr std::size_t kMinForTerms = 5, kMinForKnots = 16;
CostFit fit_cost(std::span<const Measurement> measurements);

// seconds = c · operations by least squares of the seconds, as in the paper's Figure 9, and how
// much of the variance it explains: less than none (below 0) where a constant would explain more.
struct FormulaFit {
  double seconds_per_operation = 0;  // c
  double r_squared = 0;              // 1 for fewer than two different times
  // The same with what does not depend on the parameter: seconds = a + c · operations.
  double fixed_s = 0, seconds_per_operation_above = 0;
  double r_squared_above = 0;  // in [0, 1]
};
FormulaFit fit_formula(std::span<const Measurement> measurements);

}  // namespace psygen::synthesis
