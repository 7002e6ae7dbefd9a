// How well the paper's formulas and the cost model describe the machine: the time over each
// parameter that a formula names (the paper's Figure 9), and the error of predictions for models
// that the cost model was not calibrated with. Runs models; one thread; for tools, not for the
// tick.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/synthesis/cost_model.hpp"

namespace psygen::synthesis {

// What one value of a parameter costs.
struct CurvePoint {
  double value = 0;       // of the parameter
  double seconds = 0;     // mean over the seeds
  double operations = 0;  // by the formula
  // By the cost model; none where it was calibrated with nothing like it (CostModel::covers).
  std::optional<double> predicted_s;
};

// Level 0 of one type over one parameter, everything else at its default. No points: not measured.
struct CostCurve {
  models::ModelIndex model = 0;
  std::string parameter;
  std::vector<CurvePoint> points;
  FormulaFit formula;  // of the points
};

// Curves of every type over every integer parameter that its formula depends on, within the
// parameter's soft range; models with a seed are the mean of `seeds` of them.
// Ends after options.seconds_limit: what comes later has no points.
std::vector<CostCurve> cost_curves(const models::Registry& registry, const CostModel& cost,
                                   const CalibrationOptions& options, int seeds,
                                   const std::function<void(double)>& progress = {});

// `count` legal parameter sets of every type, drawn from the soft ranges; seeds from all numbers.
std::vector<CostSample> random_samples(const models::Registry& registry, std::size_t count,
                                       std::uint64_t seed);

// How far predictions are off: for a level, for a type, and for all of them.
struct LevelAccuracy {
  models::ModelIndex model = 0;
  int level = 0;
  CostError error;
};
struct TypeAccuracy {
  models::ModelIndex model = 0;
  CostError error;  // of all its levels together
};
struct Accuracy {
  std::vector<LevelAccuracy> levels;  // count 0: not measured
  CostError all;
  std::optional<TypeAccuracy> worst;  // by p95, of the types that were measured
  std::vector<std::string> failures;  // as in CalibrationReport
};

// The errors of what `cost` predicts for samples, each measured at every level. Ends after
// options.seconds_limit: what comes later is not measured.
Accuracy accuracy_of(const models::Registry& registry, const CostModel& cost,
                     std::span<const CostSample> samples, const CalibrationOptions& options,
                     const std::function<void(double)>& progress = {});

}  // namespace psygen::synthesis
