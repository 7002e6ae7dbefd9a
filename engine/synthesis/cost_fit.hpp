// The work of a synthesis and the fitted cost curve: a line, seconds = fixed + per_operation ·
// operations + per_triangle · triangles + per_step · steps, with no negative coefficient, times a
// correction over steps that bends the line where time is not proportional to work. Operations
// follow the type's asymptotic formula (paper, section 5.2). Triangles and steps are exact and
// include the effect of the seed: the size of the level, and the number of growth steps behind it
// (ModelType::steps). Pure.
#pragma once

#include <array>
#include <cstddef>
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

}  // namespace psygen::synthesis
