#include "engine/synthesis/cost_curves.hpp"

#include <algorithm>
#include <cmath>

namespace psygen::synthesis {
namespace {

constexpr std::size_t kMaxPoints = 13;

// Returns true if the formula of level 0 depends on this integer.
bool is_cost_parameter(const models::ModelType& type, std::size_t i) {
  const models::ParameterSpec& spec = type.parameters()[i];
  if (spec.type != models::ParameterType::kInteger ||
      spec.source != models::ParameterSource::kUser) {
    return false;
  }
  models::Parameters low = models::default_parameters(type), high = low;
  low.set_integer(i, static_cast<std::int64_t>(spec.soft_min));
  high.set_integer(i, static_cast<std::int64_t>(spec.soft_max));
  return type.complexity(low, 0) != type.complexity(high, 0);
}

// Returns up to kMaxPoints integers from the smallest to the largest.
std::vector<std::int64_t> values_of(const models::ParameterSpec& spec) {
  const auto low = static_cast<std::int64_t>(spec.soft_min);
  const auto high = static_cast<std::int64_t>(spec.soft_max);
  const auto count = std::min<std::int64_t>(high - low + 1, kMaxPoints);
  std::vector<std::int64_t> values;
  for (std::int64_t k = 0; k < count; ++k)
    values.push_back(count == 1 ? low : low + (high - low) * k / (count - 1));
  return values;
}

void add(Work& sum, const Work& work, double share) {
  sum.operations += share * work.operations;
  sum.triangles += share * work.triangles;
  sum.steps += share * work.steps;
}

// One sample and its shortest time; no time until it is measured.
struct Run {
  CostSample sample;
  std::optional<Measurement> measured;
};

// Returns the runs for one value of a parameter: one, or one for each seed.
std::vector<Run> runs_at(const models::ModelType& type, CostSample sample, int seeds) {
  std::vector<Run> runs;
  const int seed = models::parameter_index(type, "seed");
  for (int s = 0; s < (seed < 0 ? 1 : seeds); ++s) {
    if (seed >= 0) sample.parameters.set_integer(static_cast<std::size_t>(seed), s);
    runs.push_back({sample, std::nullopt});
  }
  return runs;
}

// Returns false if a run was never measured: its synthesis fails, or the time is up.
bool measure_all(std::vector<Run>& runs, const CostModel& cost, const CalibrationOptions& options,
                 double deadline_s) {
  CalibrationReport ignored;
  for (Run& run : runs) {
    const auto now = cost.measure(run.sample, 0, options, deadline_s, ignored);
    if (now && (!run.measured || now->seconds < run.measured->seconds)) run.measured = now;
    if (!run.measured) return false;
  }
  return true;
}

// Returns the mean over the runs, all of which are measured.
CurvePoint point_of(std::span<const Run> runs, double value, const CostModel& cost) {
  const double share = 1.0 / static_cast<double>(runs.size());
  CurvePoint point{value, 0, 0, {}};
  Work mean{0, 0, 0};
  double predicted_s = 0;
  for (const Run& run : runs) {
    point.seconds += share * run.measured->seconds;
    add(mean, run.measured->work, share);
    predicted_s += share * cost.predict_from(run.sample.model, 0, run.measured->work);
  }
  point.operations = mean.operations;
  if (cost.covers(runs[0].sample.model, 0, mean)) point.predicted_s = predicted_s;
  return point;
}

std::vector<CurvePoint> points_over(const models::ModelType& type, models::ModelIndex model,
                                    std::size_t parameter, const CostModel& cost, int seeds,
                                    const CalibrationOptions& options, double deadline_s) {
  struct Value {
    double value;
    std::vector<Run> runs;
  };
  std::vector<Value> values;
  for (const std::int64_t value : values_of(type.parameters()[parameter])) {
    CostSample sample{model, models::default_parameters(type)};
    sample.parameters.set_integer(parameter, value);
    if (!models::validate(type, sample.parameters)) continue;
    Value at{static_cast<double>(value), runs_at(type, sample, seeds)};
    if (measure_all(at.runs, cost, options, deadline_s)) values.push_back(std::move(at));
  }
  // Other programs disturb single measurements, so the shortest counts.
  for (int sweep = 1; sweep < options.sweeps; ++sweep) {
    for (Value& at : values)
      measure_all(at.runs, cost, options, deadline_s);
  }
  std::vector<CurvePoint> points;
  for (const Value& at : values)
    points.push_back(point_of(at.runs, at.value, cost));
  return points;
}

// Returns the number of levels of a type's samples; all levels if there are no samples.
int needed_levels(const models::ModelType& type, models::ModelIndex model,
                  std::span<const CostSample> samples) {
  int most = 0;
  for (const CostSample& sample : samples)
    if (sample.model == model) most = std::max(most, type.level_count_of(sample.parameters));
  return most == 0 ? type.level_count() : most;
}

// Returns the samples of a type that have a level.
std::vector<const CostSample*> samples_with(const models::ModelType& type, models::ModelIndex model,
                                            int level, std::span<const CostSample> samples) {
  std::vector<const CostSample*> chosen;
  for (const CostSample& sample : samples) {
    if (sample.model == model && level < type.level_count_of(sample.parameters))
      chosen.push_back(&sample);
  }
  return chosen;
}

// Returns the prediction errors for a level of samples that have it, in percent.
std::vector<double> errors_of(const CostModel& cost, int level,
                              std::span<const CostSample* const> chosen,
                              const CalibrationOptions& options, double deadline_s,
                              CalibrationReport& report) {
  std::vector<std::optional<Measurement>> measured(chosen.size());
  for (int sweep = 0; sweep < std::max(options.sweeps, 1); ++sweep) {
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (sweep > 0 && !measured[i]) continue;  // its synthesis failed
      const auto now = cost.measure(*chosen[i], level, options, deadline_s, report);
      if (now && (!measured[i] || now->seconds < measured[i]->seconds)) measured[i] = now;
    }
  }
  std::vector<double> percents;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (!measured[i]) continue;
    const Measurement& m = *measured[i];
    const double predicted = cost.predict_from(chosen[i]->model, level, m.work);
    percents.push_back(std::abs(predicted - m.seconds) / m.seconds * 100);
  }
  return percents;
}

CostError error_of(std::vector<double>& percents) {
  return {percents.size(), quantile(percents, 0.50), quantile(percents, 0.95)};
}

double draw(const models::ParameterSpec& spec, core::RandomStream& random) {
  return spec.type == models::ParameterType::kInteger
             ? static_cast<double>(random.next_integer(static_cast<std::int64_t>(spec.soft_min),
                                                       static_cast<std::int64_t>(spec.soft_max)))
             : random.next_real(spec.soft_min, spec.soft_max);
}

models::Parameters random_parameters(const models::ModelType& type, core::RandomStream& random) {
  models::Parameters p = models::default_parameters(type);
  const auto specs = type.parameters();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    if (specs[i].name == "seed") {
      const auto any = static_cast<std::int64_t>(random.next_u64() >> 1);
      p.set_integer(i, specs[i].hard_max >= 0x1.0p62 ? any : any % 1'000'000);
    } else if (specs[i].source == models::ParameterSource::kUser) {
      const double value = draw(specs[i], random);
      specs[i].type == models::ParameterType::kInteger
          ? p.set_integer(i, static_cast<std::int64_t>(value))
          : p.set_real(i, value);
    }
  }
  return p;
}

}  // namespace

std::vector<CostCurve> cost_curves(const models::Registry& registry, const CostModel& cost,
                                   const CalibrationOptions& options, int seeds,
                                   const std::function<void(double)>& progress) {
  const double deadline_s = options.wall_clock() + options.seconds_limit;
  std::vector<CostCurve> curves;
  for (std::size_t m = 0; m < registry.size(); ++m) {
    const auto model = static_cast<models::ModelIndex>(m);
    const models::ModelType& type = registry[model];
    for (std::size_t i = 0; i < type.parameters().size(); ++i) {
      if (!is_cost_parameter(type, i)) continue;
      CostCurve curve{model, std::string(type.parameters()[i].name), {}, {}};
      curve.points = points_over(type, model, i, cost, seeds, options, deadline_s);
      std::vector<Measurement> measured;
      for (const CurvePoint& point : curve.points)
        measured.push_back({{point.operations, 0, 0}, point.seconds});
      curve.formula = fit_formula(measured);
      curves.push_back(std::move(curve));
    }
    if (progress) progress(static_cast<double>(m + 1) / static_cast<double>(registry.size()));
  }
  return curves;
}

std::vector<CostSample> random_samples(const models::Registry& registry, std::size_t count,
                                       std::uint64_t seed) {
  std::vector<CostSample> samples;
  for (std::size_t m = 0; m < registry.size(); ++m) {
    const auto model = static_cast<models::ModelIndex>(m);
    core::RandomStream random(seed, 0, 0, model, core::Purpose::kParameters);
    // Parameters at their upper ends may give too large a mesh. In that case draws again, a few
    // times.
    std::size_t found = 0;
    for (std::size_t tries = 0; found < count && tries < 100 * count; ++tries) {
      const models::Parameters p = random_parameters(registry[model], random);
      if (!models::validate(registry[model], p)) continue;
      samples.push_back({model, p});
      ++found;
    }
  }
  return samples;
}

Accuracy accuracy_of(const models::Registry& registry, const CostModel& cost,
                     std::span<const CostSample> samples, const CalibrationOptions& options,
                     const std::function<void(double)>& progress) {
  const double deadline_s = options.wall_clock() + options.seconds_limit;
  Accuracy accuracy;
  CalibrationReport report;
  std::vector<double> all;
  for (std::size_t m = 0; m < registry.size(); ++m) {
    const auto model = static_cast<models::ModelIndex>(m);
    std::vector<double> of_type;
    const models::ModelType& type = registry[model];
    for (int level = 0; level < needed_levels(type, model, samples); ++level) {
      std::vector<double> percents = errors_of(
          cost, level, samples_with(type, model, level, samples), options, deadline_s, report);
      of_type.insert(of_type.end(), percents.begin(), percents.end());
      accuracy.levels.push_back({model, level, error_of(percents)});
    }
    all.insert(all.end(), of_type.begin(), of_type.end());
    const CostError error = error_of(of_type);
    const bool worse = !accuracy.worst || error.p95_percent > accuracy.worst->error.p95_percent;
    if (error.count > 0 && worse) accuracy.worst = {model, error};
    if (progress) progress(static_cast<double>(m + 1) / static_cast<double>(registry.size()));
  }
  accuracy.all = error_of(all);
  accuracy.failures = std::move(report.failures);
  return accuracy;
}

}  // namespace psygen::synthesis
