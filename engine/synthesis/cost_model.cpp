#include "engine/synthesis/cost_model.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "engine/synthesis/synthesise.hpp"

namespace psygen::synthesis {
namespace {
// Cost of types before calibration and of unregistered types.
constexpr CostFit kUnknown{.fixed_s = 0.3e-6, .per_triangle_s = 5e-9, .per_step_s = 10e-9};

// Element [model][level], or that of the type's nearest level.
template <class T>
const T& at(const std::vector<std::vector<T>>& table, models::ModelIndex model, int level) {
  const std::vector<T>& levels = table[model];
  return levels[static_cast<std::size_t>(
      std::clamp(level, 0, static_cast<int>(levels.size()) - 1))];
}

// Returns the seconds that reading the clock takes, which every request adds.
double clock_seconds(const std::function<double()>& clock) {
  constexpr int kCalls = 64;
  const double start_s = clock();
  for (int i = 1; i < kCalls; ++i)
    (void)clock();
  return (clock() - start_s) / kCalls;
}

WorkRange range_of(std::span<const Measurement> measured) {
  WorkRange range{measured[0].work, measured[0].work};
  for (const Measurement& m : measured) {
    for (double Work::*part : {&Work::operations, &Work::triangles, &Work::steps}) {
      range.least.*part = std::min(range.least.*part, m.work.*part);
      range.most.*part = std::max(range.most.*part, m.work.*part);
    }
  }
  return range;
}
}  // namespace

bool WorkRange::holds(const Work& work) const {
  for (double Work::*part : {&Work::operations, &Work::triangles, &Work::steps}) {
    if (work.*part * kSlack < least.*part || work.*part > most.*part * kSlack) return false;
  }
  return true;
}

double quantile(std::span<double> values, double p) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const double h = p * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(h);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (values[high] - values[low]) * (h - static_cast<double>(low));
}

CostModel::CostModel(const models::Registry& registry) : registry_(registry) {
  for (std::size_t m = 0; m < registry.size(); ++m) {
    const models::ModelType& type = registry[static_cast<models::ModelIndex>(m)];
    const auto levels = static_cast<std::size_t>(std::max(type.level_count(), 1));
    CostFit guess = kUnknown;
    if (const double step_s = type.step_seconds(); std::isfinite(step_s) && step_s >= 0)
      guess.per_step_s = step_s;
    fits_.emplace_back(levels, guess);
    ranges_.emplace_back(levels);
    corrections_.emplace_back(levels);
    const std::type_index code(typeid(type));
    codes_.push_back(static_cast<std::size_t>(std::ranges::find(kinds_, code) - kinds_.begin()));
    if (codes_.back() == kinds_.size()) kinds_.push_back(code);
    names_.emplace_back(type.name());
  }
  cold_by_code_.resize(std::max<std::size_t>(kinds_.size(), 1));
}

void CostModel::learn_from(const CostModel& other) {
  for (std::size_t m = 0; m < names_.size(); ++m) {
    const auto at =
        static_cast<std::size_t>(std::ranges::find(other.names_, names_[m]) - other.names_.begin());
    if (at == other.names_.size() || other.kinds_[other.codes_[at]] != kinds_[codes_[m]] ||
        other.fits_[at].size() != fits_[m].size())
      continue;
    fits_[m] = other.fits_[at];
    ranges_[m] = other.ranges_[at];
    corrections_[m] = other.corrections_[at];
  }
  for (std::size_t code = 0; code < kinds_.size(); ++code) {
    const auto at = static_cast<std::size_t>(std::ranges::find(other.kinds_, kinds_[code]) -
                                             other.kinds_.begin());
    if (at < other.kinds_.size()) cold_by_code_[code] = other.cold_by_code_[at];
  }
  request_s_ = other.request_s_;
}

const CostFit& CostModel::fit(models::ModelIndex model, int level) const {
  return model < fits_.size() ? at(fits_, model, level) : kUnknown;
}

std::size_t CostModel::code_of(models::ModelIndex model) const {
  return model < codes_.size() ? codes_[model] : 0;
}

bool CostModel::covers(models::ModelIndex model, int level, const Work& work) const {
  if (model >= ranges_.size() || level < 0) return false;
  const auto at = static_cast<std::size_t>(level);
  const auto& levels = ranges_[model];
  return at < levels.size() && levels[at] && levels[at]->holds(work);
}

Work CostModel::work(models::ModelIndex model, const models::Parameters& parameters, int level,
                     std::optional<models::MeshSize>* size) const {
  Work work;
  if (size != nullptr) size->reset();
  if (model >= registry_.size()) return work;
  try {  // model types of users may throw; the engine's own do not
    const double x = registry_[model].complexity(parameters, level);
    if (std::isfinite(x) && x > 0) work.operations = x;
    const models::MeshSize mesh = registry_[model].mesh_size(parameters, level);
    work.triangles = mesh.triangle_count();
    if (size != nullptr) *size = mesh;
    work.steps = registry_[model].steps(parameters, level);
    if (!std::isfinite(work.steps) || work.steps <= 0)
      work.steps =
          level == 0 ? work.triangles : registry_[model].mesh_size(parameters, 0).triangle_count();
  } catch (...) {
  }
  return work;
}

double CostModel::predict_from(models::ModelIndex model, int level, const Work& work) const {
  return std::clamp(fit(model, level).seconds(work), 1e-9, 1e6);
}

double CostModel::predict(models::ModelIndex model, const models::Parameters& parameters,
                          int level) const {
  return predict_from(model, level, work(model, parameters, level));
}

RequestCost CostModel::predict_request(models::ModelIndex model, int level,
                                       const Work& work) const {
  const double curve_s = request_s_ + predict_from(model, level, work);
  RequestCost cost;
  cost.seconds.fill(curve_s);
  if (model >= corrections_.size()) return cost;
  cost.code = codes_[model];
  const CostCorrection& correction = at(corrections_, model, level);
  for (std::size_t warmth = 0; warmth < kWarmths; ++warmth) {
    cost.seconds[warmth] =
        correction.seconds(curve_s, static_cast<Warmth>(warmth), cold_by_code_[cost.code]);
  }
  return cost;
}

void CostModel::observe(models::ModelIndex model, int level, const Work& work, Warmth warmth,
                        double seconds) {
  if (model >= fits_.size() || level < 0 ||
      static_cast<std::size_t>(level) >= fits_[model].size() || !(seconds > 0) ||
      !(work.operations > 0)) {
    return;
  }
  corrections_[model][static_cast<std::size_t>(level)].observe(
      request_s_ + predict_from(model, level, work), warmth, seconds, cold_by_code_[codes_[model]]);
}

std::optional<Measurement> CostModel::measure(const CostSample& sample, int level,
                                              const CalibrationOptions& options, double deadline_s,
                                              CalibrationReport& report) const {
  const models::ModelType& type = registry_[sample.model];
  const auto destination = HeapDestination::make(type, sample.parameters, level);
  if (!destination) {
    report.failures.push_back(destination.error().message);
    return std::nullopt;
  }
  double least = std::numeric_limits<double>::infinity();
  int repeats = 1;
  // The first round warms up and sizes the measurement.
  for (int round = 0; round <= options.rounds; ++round) {
    if (options.wall_clock() >= deadline_s) break;
    const double cpu_start = options.cpu_clock(), start = options.wall_clock();
    for (int i = 0; i < repeats; ++i) {
      const SynthesisOutcome outcome =
          synthesise_guarded(type, sample.parameters, level, destination->view());
      if (!outcome.ok) {
        report.failures.push_back(outcome.error);
        return std::nullopt;
      }
    }
    // Reading the processor time is a system call that measures itself too; the wall clock also
    // counts other threads. The smaller of the two is nearer to the truth.
    const double elapsed = options.wall_clock() - start;
    const double each = std::min(elapsed, options.cpu_clock() - cpu_start) / repeats;
    ++report.measurements;
    least = std::min(least, each);
    if (round == 0) {
      const double want = options.seconds_per_measurement / std::max(each, 1e-8);
      repeats = static_cast<int>(std::clamp(std::ceil(want), 1.0, 1000.0));
    }
  }
  if (!std::isfinite(least) || least <= 0) return std::nullopt;
  return Measurement{work(sample.model, sample.parameters, level), least};
}

LevelCalibration CostModel::calibrate_level(models::ModelIndex model, int level,
                                            std::span<const CostSample> samples,
                                            const CalibrationOptions& options, double deadline_s,
                                            CalibrationReport& report,
                                            std::vector<double>& errors) {
  struct Candidate {
    Work work;
    const CostSample* sample;
  };
  std::vector<Candidate> cheapest_first;
  for (const CostSample& s : samples) {
    if (s.model == model) cheapest_first.push_back({work(model, s.parameters, level), &s});
  }
  std::stable_sort(
      cheapest_first.begin(), cheapest_first.end(),
      [](const Candidate& a, const Candidate& b) { return a.work.operations < b.work.operations; });
  std::vector<Measurement> measured;
  std::vector<const CostSample*> taken;
  std::vector<double> ratios;
  const auto set = [&](const CostFit& line) {  // also the best guess for levels not measured yet
    for (int finer = level; finer >= 0; --finer)
      fits_[model][static_cast<std::size_t>(finer)] = line;
  };
  const auto set_guess = [&] { set({.per_operation_s = quantile(ratios, 0.5)}); };
  for (const auto& [planned, sample] : cheapest_first) {
    const double expected = predict_from(model, level, planned) * (options.rounds + 1);
    if (options.wall_clock() + expected >= deadline_s) break;
    const auto m = measure(*sample, level, options, deadline_s, report);
    if (!m) continue;
    measured.push_back(*m);
    taken.push_back(sample);
    ratios.push_back(m->seconds / m->work.operations);
    if (std::has_single_bit(ratios.size())) set_guess();  // sorting after each would be quadratic
  }
  if (!ratios.empty()) set_guess();
  for (int sweep = 1; sweep < options.sweeps; ++sweep) {
    for (std::size_t i = 0; i < taken.size(); ++i) {
      const auto again = measure(*taken[i], level, options, deadline_s, report);
      if (again) measured[i].seconds = std::min(measured[i].seconds, again->seconds);
    }
  }
  if (measured.size() >= kMinForTerms) {
    set(fit_cost(measured));
    corrections_[model][static_cast<std::size_t>(level)].trust_curve();
  }
  LevelCalibration result{model, level, fit(model, level), 0,
                          static_cast<std::uint32_t>(measured.size())};
  auto& range = ranges_[model][static_cast<std::size_t>(level)];
  range.reset();
  if (measured.empty()) return result;
  range = range_of(measured);
  std::vector<double> level_errors;
  for (const Measurement& m : measured)
    level_errors.push_back(std::abs(m.seconds - result.fit.seconds(m.work)) / m.seconds * 100);
  errors.insert(errors.end(), level_errors.begin(), level_errors.end());
  result.fit_error_percent = quantile(level_errors, 0.5);
  return result;
}

CalibrationReport CostModel::calibrate(std::span<const CostSample> samples,
                                       const CalibrationOptions& options,
                                       const std::function<void(double)>& progress) {
  std::vector<CostSample> defaults;
  if (samples.empty()) {
    for (std::size_t m = 0; m < registry_.size(); ++m) {
      const auto model = static_cast<models::ModelIndex>(m);
      defaults.push_back({model, models::default_parameters(registry_[model])});
    }
    samples = defaults;
  }
  const double start = options.wall_clock();
  request_s_ = clock_seconds(options.cpu_clock);
  std::size_t total = 0, done = 0;
  for (const auto& levels : fits_)
    total += levels.size();
  CalibrationReport report;
  std::vector<double> errors;
  for (std::size_t m = 0; m < fits_.size(); ++m) {
    // Each type may use its fraction of the remaining time, so that a slow one does not starve the
    // others.
    const double now = options.wall_clock();
    const double left = start + options.seconds_limit - now;
    const double share = left / static_cast<double>(fits_.size() - m);
    for (int level = static_cast<int>(fits_[m].size()) - 1; level >= 0; --level) {
      report.levels.push_back(calibrate_level(static_cast<models::ModelIndex>(m), level, samples,
                                              options, now + share, report, errors));
      if (progress) progress(static_cast<double>(++done) / static_cast<double>(total));
    }
  }
  report.fit_error_percent_p50 = quantile(errors, 0.50);
  report.fit_error_percent_p95 = quantile(errors, 0.95);
  report.seconds = options.wall_clock() - start;
  return report;
}

}  // namespace psygen::synthesis
