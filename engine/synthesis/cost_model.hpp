// Predicts the duration of a synthesis with one measured curve over operations, triangles and steps
// (cost_fit.hpp) per model type and level (paper, sections 5.2 and 6: the constants are computed at
// start-up). Calibrated in well under a second, then corrected by every finished request, which
// meets colder caches (cost_fit.hpp). One thread. Not a profiler. predict() and observe() are O(1)
// plus the type's complexity(), mesh_size() and steps().
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <typeindex>
#include <vector>

#include "engine/core/clock.hpp"
#include "engine/models/registry.hpp"
#include "engine/synthesis/cost_fit.hpp"

namespace psygen::synthesis {

// A model to measure, with valid parameters of its type.
struct CostSample {
  models::ModelIndex model = 0;
  models::Parameters parameters;
};

// Duration and precision of calibration.
struct CalibrationOptions {
  // Wall-clock time after which measuring ends. A level whose predicted time exceeds the rest is
  // skipped. Only a model that is slower than its own formula predicts can exceed the limit.
  double seconds_limit = 0.4;
  // A short synthesis is repeated until one measurement takes at least this long.
  double seconds_per_measurement = 20e-6;
  int rounds = 3;  // measurements per sample and level; the shortest counts
  int sweeps = 1;  // passes over all samples of a level; the shortest counts again
  std::function<double()> wall_clock = core::monotonic_seconds;
  std::function<double()> cpu_clock = core::thread_cpu_seconds;
};

// Calibration result of one level of a type.
struct LevelCalibration {
  models::ModelIndex model = 0;
  int level = 0;
  CostFit fit;
  double fit_error_percent = 0;  // median over the samples of |measured − fit| / measured
  std::uint32_t samples = 0;     // 0: skipped, the fit is that of a coarser level
};

// Range of the work that was measured at a level.
struct WorkRange {
  static constexpr double kSlack = 1.25;  // factor beyond either end
  Work least, most;
  // Returns true if the work lies within the measured range. Predictions outside it are unchecked.
  bool holds(const Work& work) const;
};

// Result of a calibration, and its duration.
struct CalibrationReport {
  std::vector<LevelCalibration> levels;
  double seconds = 0;                // wall-clock time spent
  double fit_error_percent_p50 = 0;  // over all samples and levels
  double fit_error_percent_p95 = 0;
  std::uint64_t measurements = 0;
  std::vector<std::string> failures;  // "rock level 2 threw: ...": not measured
};

// Errors of predictions against measurements.
struct CostError {
  std::uint64_t count = 0;  // measurements behind the percentiles
  double p50_percent = 0;   // of |predicted − measured| / measured
  double p95_percent = 0;
};

// The registry must outlive it.
class CostModel {
 public:
  // Before calibration, a step costs what its type declares and a triangle costs 5 ns.
  explicit CostModel(const models::Registry& registry);

  // Copies the learned costs of types with the same name, code and levels from another model.
  void learn_from(const CostModel& other);

  // Measures the samples (by default each type's default parameters) at every level, coarsest
  // first.
  // `progress`, if given, is called with a fraction in [0, 1] after each type and level.
  CalibrationReport calibrate(std::span<const CostSample> samples = {},
                              const CalibrationOptions& options = {},
                              const std::function<void(double)>& progress = {});

  // Returns the work of a synthesis. If the formula fails (throws, NaN, not positive), it counts
  // one operation; if the size is unknown, no triangles. `size`, if given, receives the size of the
  // mesh, so that callers need not ask again, or nullopt if the type cannot tell it.
  Work work(models::ModelIndex model, const models::Parameters& parameters, int level,
            std::optional<models::MeshSize>* size = nullptr) const;
  // Predicted seconds of one core with warm caches, by the calibrated curve. Finite and positive
  // for any model and level.
  double predict(models::ModelIndex model, const models::Parameters& parameters, int level) const;
  double predict_from(models::ModelIndex model, int level, const Work& work) const;

  // Predicted cost of a request to a modeler, including claiming and timing, corrected by
  // observations.
  RequestCost predict_request(models::ModelIndex model, int level, const Work& work) const;
  // Records a finished request: measured seconds of one core.
  void observe(models::ModelIndex model, int level, const Work& work, Warmth warmth,
               double seconds);
  // Types that run the same code, and so warm each other's caches, share a number.
  std::size_t code_of(models::ModelIndex model) const;

  // Returns the shortest CPU time of a few repetitions; nullopt if the type failed or the time is
  // up.
  std::optional<Measurement> measure(const CostSample& sample, int level,
                                     const CalibrationOptions& options, double deadline_s,
                                     CalibrationReport& report) const;
  // Returns true if calibration measured similar work at this level; false before calibration.
  bool covers(models::ModelIndex model, int level, const Work& work) const;
  const CostFit& fit(models::ModelIndex model, int level) const;

 private:
  LevelCalibration calibrate_level(models::ModelIndex model, int level,
                                   std::span<const CostSample> samples,
                                   const CalibrationOptions& options, double deadline_s,
                                   CalibrationReport& report, std::vector<double>& errors);

  const models::Registry& registry_;
  std::vector<std::vector<CostFit>> fits_;                     // [model][level]
  std::vector<std::vector<std::optional<WorkRange>>> ranges_;  // [model][level]; none: not measured
  std::vector<std::vector<CostCorrection>> corrections_;       // [model][level]
  std::vector<std::size_t> codes_;                             // [model]
  std::vector<std::string> names_;                             // [model]
  std::vector<std::type_index> kinds_;                         // [code]
  std::vector<ColdSeconds> cold_by_code_;
  double request_s_ = 0;  // added by every request to its synthesis
};

// The p-quantile (0 … 1) by linear interpolation at h = p(N − 1); 0 for no values. Reorders them.
double quantile(std::span<double> values, double p);

}  // namespace psygen::synthesis
