// Checks how well the paper's formulas and the cost model describe this machine: the time over each
// parameter of a formula (the paper's Figure 9), and the prediction error for models outside the
// calibration set. Runs models; one thread; for tools, not for the tick.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/synthesis/cost_model.hpp"

namespace psygen::synthesis {

// Cost of one value of a parameter.
struct CurvePoint {
  double value = 0;       // of the parameter
  double seconds = 0;     // mean over the seeds
  double operations = 0;  // by the formula
  // By the cost model; none if it was calibrated with nothing similar (CostModel::covers).
  std::optional<double> predicted_s;
};

// Cost of level 0 of one type over one parameter, all others at their defaults. Without points if
// it was not measured.
struct CostCurve {
  models::ModelIndex model = 0;
  std::string parameter;
  std::vector<CurvePoint> points;
  FormulaFit formula;  // fitted to the points
};

// Curves of every type over every integer parameter that its formula depends on, within the
// parameter's soft range. Models with a seed are averaged over `seeds` seeds. Stops after
// options.seconds_limit: the remaining curves have no points.
std::vector<CostCurve> cost_curves(const models::Registry& registry, const CostModel& cost,
                                   const CalibrationOptions& options, int seeds,
                                   const std::function<void(double)>& progress = {});

// Returns `count` valid parameter sets of every type, drawn from the soft ranges; seeds from all
// numbers.
std::vector<CostSample> random_samples(const models::Registry& registry, std::size_t count,
                                       std::uint64_t seed);

// Prediction errors of a level, of a type, and of all types.
struct LevelAccuracy {
  models::ModelIndex model = 0;
  int level = 0;
  CostError error;
};
struct TypeAccuracy {
  models::ModelIndex model = 0;
  CostError error;  // over all its levels
};
struct Accuracy {
  std::vector<LevelAccuracy> levels;  // count 0: not measured
  CostError all;
  std::optional<TypeAccuracy> worst;  // by p95, among the types that were measured
  std::vector<std::string> failures;  // as in CalibrationReport
};

// Measures every sample at every level and returns the errors of the predictions of `cost`. Stops
// after options.seconds_limit: the remaining levels are not measured.
Accuracy accuracy_of(const models::Registry& registry, const CostModel& cost,
                     std::span<const CostSample> samples, const CalibrationOptions& options,
                     const std::function<void(double)>& progress = {});

}  // namespace psygen::synthesis
