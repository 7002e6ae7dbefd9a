// How long a synthesis takes: one measured curve over operations, triangles and steps
// (cost_fit.hpp) per model type and level (paper, sections 5.2 and 6: the constants are computed at
// start-up). Calibrated in well under a second, then corrected by every finished request, which
// meets colder caches (cost_correction.hpp); it keeps the error of its own predictions, so
// every figure that a schedule uses has been checked.
// One thread. Not a profiler. predict() and observe() are O(1) beside the type's complexity(),
// mesh_size() and steps().
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <typeindex>
#include <vector>

#include "engine/models/registry.hpp"
#include "engine/synthesis/cost_correction.hpp"
#include "engine/synthesis/cost_fit.hpp"

namespace psygen::synthesis {

// A model to measure, with legal parameters of its type.
struct CostSample {
  models::ModelIndex model = 0;
  models::Parameters parameters;
};

// How long and how exactly calibration measures.
struct CalibrationOptions {
  // Wall-clock time after which nothing more is measured. A level whose predicted time does not fit
  // any more is skipped, so that only a model that is slower than its own formula says can run
  // over.
  double seconds_limit = 0.4;
  // Short syntheses are repeated until one measurement is at least this long.
  double seconds_per_measurement = 20e-6;
  int rounds = 3;  // measurements per sample and level; the least counts
  int sweeps = 1;  // times that all samples of a level are gone through; again the least counts
  std::function<double()> wall_clock = {};  // default: core::monotonic_seconds
  std::function<double()> cpu_clock = {};   // default: core::thread_cpu_seconds
};

// What calibration found out about one level of a type.
struct LevelCalibration {
  models::ModelIndex model = 0;
  int level = 0;
  CostFit fit;
  double fit_error_percent = 0;  // median over the samples of |measured − fit| / measured
  std::uint32_t samples = 0;     // 0: skipped, the fit was carried over from a coarser level
};

// What the measurements of a level had to do, from the least to the most of each.
struct WorkRange {
  static constexpr double kSlack = 1.25;  // beyond either end
  Work least, most;
  // Whether work of this size lies within what was measured. Predictions beyond are unchecked.
  bool holds(const Work& work) const;
};

// What calibration found out, and what it took.
struct CalibrationReport {
  std::vector<LevelCalibration> levels;
  double seconds = 0;                // wall-clock time spent
  double fit_error_percent_p50 = 0;  // over all samples and levels
  double fit_error_percent_p95 = 0;
  std::uint64_t measurements = 0;
  std::vector<std::string> failures;  // "rock level 2 threw: ...": those are not measured
};

// How far predictions were from what requests took.
struct CostError {
  std::uint64_t count = 0;  // observations over which the percentiles are taken, at most 4,096
  double p50_percent = 0;   // of |predicted − measured| / measured
  double p95_percent = 0;
};

// The registry must outlive it.
class CostModel {
 public:
  // Before calibration every step takes what its type says, and a triangle 5 ns.
  explicit CostModel(const models::Registry& registry);

  // Takes over what another model knows of types with the same name, code and levels.
  void learn_from(const CostModel& other);

  // Measures the samples (or, without any, each type's defaults) at every level, coarsest first.
  // `progress`, if given, is called with a fraction in [0, 1] after each type and level.
  CalibrationReport calibrate(std::span<const CostSample> samples = {},
                              const CalibrationOptions& options = {},
                              const std::function<void(double)>& progress = {});

  // What synthesising it has to do. Where the formula fails (throws, NaN, not positive) one
  // operation, where the size is unknown no triangle. `size`, if given, is set to the size of the
  // mesh, so that it is not counted twice; to nothing if the type cannot tell it.
  Work work(models::ModelIndex model, const models::Parameters& parameters, int level,
            std::optional<models::MeshSize>* size = nullptr) const;
  // Seconds of one core with warm caches, by the calibrated curve. Finite and positive for any
  // model and level.
  double predict(models::ModelIndex model, const models::Parameters& parameters, int level) const;
  double predict_from(models::ModelIndex model, int level, const Work& work) const;

  // The same of a request to a modeler: with what claiming and timing it takes, corrected by what
  // was observed.
  RequestCost predict_request(models::ModelIndex model, int level, const Work& work) const;
  // A finished request: what had been predicted, what it took (seconds of one core).
  void observe(models::ModelIndex model, int level, const Work& work, Warmth warmth,
               double predicted_seconds, double seconds);
  // Types that run the same code, and so warm each other's caches, have the same number.
  std::size_t code_of(models::ModelIndex model) const;

  // The least CPU time of a few repetitions; nothing if the type failed or the time is up.
  std::optional<Measurement> measure(const CostSample& sample, int level,
                                     const CalibrationOptions& options, double deadline_s,
                                     CalibrationReport& report) const;
  CostError error() const;
  // Whether calibration measured the like at this very level; false before it.
  bool covers(models::ModelIndex model, int level, const Work& work) const;
  const CostFit& fit(models::ModelIndex model, int level) const;

 private:
  LevelCalibration calibrate_level(models::ModelIndex model, int level,
                                   std::span<const CostSample> samples,
                                   const CalibrationOptions& options, double deadline_s,
                                   CalibrationReport& report, std::vector<double>& errors);

  const models::Registry& registry_;
  std::vector<std::vector<CostFit>> fits_;                     // [model][level]
  std::vector<std::vector<std::optional<WorkRange>>> ranges_;  // the same; none: not measured
  std::vector<std::vector<CostCorrection>> corrections_;       // the same
  std::vector<std::size_t> codes_;                             // [model]
  std::vector<std::string> names_;                             // [model]
  std::vector<std::type_index> kinds_;                         // [code]
  std::vector<ColdSeconds> cold_by_code_;
  double request_s_ = 0;              // that every request takes beside its synthesis
  std::vector<float> recent_errors_;  // ring, in percent
  std::size_t next_error_ = 0;
};

// The p-quantile (0 … 1) by linear interpolation at h = p(N − 1); 0 for no values. Reorders them.
double quantile(std::span<double> values, double p);

}  // namespace psygen::synthesis
