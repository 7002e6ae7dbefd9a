#include "engine/synthesis/cost_curves.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/engine/synthesis/fake_models.hpp"

namespace psygen::synthesis {
namespace {

// Measurements end at once, so that results do not depend on the machine's speed.
CalibrationOptions quick() {
  CalibrationOptions options;
  options.seconds_limit = 60;
  options.seconds_per_measurement = 1e-9;
  options.rounds = 1;
  return options;
}

TEST(CostCurves, StandardTypesHaveTheCurvesOfThePaper) {
  const models::Registry registry = models::make_standard_registry();
  const CostModel cost(registry);
  std::set<std::string> curves;
  for (const CostCurve& curve : cost_curves(registry, cost, quick(), 2)) {
    curves.insert(std::string(registry[curve.model].name()) + " " + curve.parameter);
    ASSERT_GE(curve.points.size(), 3u);
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      EXPECT_GT(curve.points[i].seconds, 0);
      EXPECT_FALSE(curve.points[i].predicted_s);  // the cost model is not calibrated
      if (i > 0) {
        EXPECT_GT(curve.points[i].value, curve.points[i - 1].value);
        EXPECT_GT(curve.points[i].operations, curve.points[i - 1].operations);
      }
    }
    EXPECT_GT(curve.formula.seconds_per_operation, 0);
  }
  for (const char* expected :
       {"terrain size", "terrain octaves", "rock subdivisions", "tree iterations", "tree branches"})
    EXPECT_TRUE(curves.contains(expected)) << expected;
}

// A type whose time is proportional to its vertices, and models of it with given numbers of
// vertices.
models::Registry proportional(double& now) {
  return testing::registry_of(std::make_unique<testing::ScriptedModel>(
      "timed", [&now](const models::Parameters& p, int level) {
        now += 1e-6 * static_cast<double>(1 + (p.integer(1) >> level));
      }));
}

std::vector<CostSample> samples_of(const models::Registry& registry,
                                   std::initializer_list<std::int64_t> vertices) {
  std::vector<CostSample> samples;
  for (const std::int64_t count : vertices) {
    samples.push_back({0, models::default_parameters(registry[0])});
    samples.back().parameters.set_integer(1, count);
  }
  return samples;
}

TEST(CostCurves, PredictsOnlyWhereTheModelWasCalibratedWithSimilarWork) {
  double now = 0;
  const models::Registry registry = proportional(now);
  CalibrationOptions options;
  options.wall_clock = options.cpu_clock = [&now] { return now; };
  options.seconds_limit = 1e9;
  CostModel cost(registry);
  cost.calibrate(samples_of(registry, {150, 250, 300, 350, 400}), options);
  const std::vector<CostCurve> curves = cost_curves(registry, cost, options, 2);
  ASSERT_EQ(curves.size(), 1u);
  std::size_t predicted = 0;
  for (const CurvePoint& point : curves[0].points) {
    const bool alike = point.value >= 150 && point.value <= 400;
    const bool near = point.value >= 150 / 1.25 && point.value <= 400 * 1.25;
    EXPECT_TRUE(point.predicted_s || !alike) << point.value;
    EXPECT_TRUE(near || !point.predicted_s) << point.value;
    if (!point.predicted_s) continue;
    ++predicted;
    EXPECT_NEAR(*point.predicted_s, point.seconds, 0.02 * point.seconds);
  }
  EXPECT_GE(predicted, 3u);
  EXPECT_LT(predicted, curves[0].points.size());
}

TEST(CostCurves, ADisturbanceDuringOneSweepDoesNotChangeThePoints) {
  double now = 0;
  std::map<std::uint64_t, int> calls;
  const models::Registry registry = testing::registry_of(
      std::make_unique<testing::ScriptedModel>("disturbed", [&](const models::Parameters& p, int) {
        const bool disturbed = ++calls[p.hash()] <= 2 && p.integer(1) % 2 == 0;
        now += 1e-6 * static_cast<double>(1 + p.integer(1)) * (disturbed ? 7 : 1);
      }));
  CalibrationOptions options;
  options.wall_clock = options.cpu_clock = [&now] { return now; };
  options.seconds_limit = 1e9;
  options.seconds_per_measurement = 1e-9;
  options.rounds = 1;  // two calls per sweep
  options.sweeps = 2;
  const std::vector<CostCurve> curves = cost_curves(registry, CostModel(registry), options, 3);
  for (const CurvePoint& point : curves[0].points)
    EXPECT_NEAR(point.seconds, 1e-6 * (1 + point.value), 1e-12) << point.value;
}

TEST(CostCurves, RandomSamplesAreLegalDifferentAndReproducible) {
  const models::Registry registry = models::make_standard_registry();
  const auto samples = random_samples(registry, 20, 1);
  ASSERT_EQ(samples.size(), 20 * registry.size());
  std::set<std::uint64_t> hashes;
  for (const CostSample& sample : samples) {
    EXPECT_TRUE(models::validate(registry[sample.model], sample.parameters));
    hashes.insert(sample.parameters.hash());
  }
  EXPECT_EQ(hashes.size(), samples.size());
  EXPECT_EQ(random_samples(registry, 20, 1).back().parameters, samples.back().parameters);
  EXPECT_NE(random_samples(registry, 20, 2).back().parameters, samples.back().parameters);
}

TEST(CostCurves, ExactPredictionsHaveNoErrorAndOthersDo) {
  double now = 0;
  const models::Registry registry = testing::registry_of(std::make_unique<testing::ScriptedModel>(
      "timed", [&now](const models::Parameters& p, int level) {
        now += 3e-6 + 1e-6 * static_cast<double>(p.integer(1) >> level);
      }));
  CalibrationOptions options;
  options.wall_clock = options.cpu_clock = [&now] { return now; };
  options.seconds_limit = 1e9;
  CostModel cost(registry);
  const auto samples = random_samples(registry, 16, 1);
  cost.calibrate(samples, options);
  const Accuracy exact = accuracy_of(registry, cost, random_samples(registry, 30, 2), options);
  EXPECT_EQ(exact.levels.size(), 3u);
  EXPECT_EQ(exact.all.count, 90u);
  EXPECT_LT(exact.all.p95_percent, 1e-3);
  const CostModel uncalibrated(registry);  // about 20 ns a vertex instead of 1 µs
  const Accuracy far = accuracy_of(registry, uncalibrated, samples, options);
  EXPECT_GT(far.all.p50_percent, 95);
}

TEST(CostCurves, ThePassesEndInTimeAndReportWhatIsMissing) {
  double now = 0;
  const models::Registry registry = testing::registry_of(std::make_unique<testing::ScriptedModel>(
      "slow", [&now](const models::Parameters&, int) { now += 1; }));
  CalibrationOptions options;
  options.wall_clock = options.cpu_clock = [&now] { return now; };
  options.seconds_limit = 20;
  const CostModel cost(registry);
  const auto samples = random_samples(registry, 30, 1);
  const Accuracy accuracy = accuracy_of(registry, cost, samples, options);
  EXPECT_LE(now, 21);
  EXPECT_GT(accuracy.levels[0].error.count, 0u);
  EXPECT_EQ(accuracy.levels[2].error.count, 0u);
  now = 0;
  cost_curves(registry, cost, options, 12);
  EXPECT_LE(now, 21);
}

TEST(CostCurves, TheWorstTypeIsNamedAndThrowingTypesAreNotMeasured) {
  double now = 0;
  models::Registry registry;
  const auto add = [&](const char* name, testing::ScriptedModel::Script script) {
    ASSERT_TRUE(registry.add(std::make_unique<testing::ScriptedModel>(name, std::move(script))));
  };
  const auto proportional = [&now](double each) {
    return [&now, each](const models::Parameters& p, int level) {
      now += each * static_cast<double>(1 + (p.integer(1) >> level));
    };
  };
  add("near", proportional(20e-9));
  add("far", proportional(5e-12));
  add("thrower", [](const models::Parameters&, int) { throw std::runtime_error("no"); });
  CalibrationOptions options;
  options.wall_clock = options.cpu_clock = [&now] { return now; };
  options.seconds_limit = 1e9;
  const CostModel cost(registry);  // about 20 ns a vertex
  const Accuracy accuracy = accuracy_of(registry, cost, random_samples(registry, 8, 1), options);
  ASSERT_TRUE(accuracy.worst);
  EXPECT_EQ(accuracy.worst->model, 1);
  EXPECT_EQ(accuracy.worst->error.count, 24u);
  EXPECT_EQ(accuracy.all.count, 48u);
  EXPECT_EQ(accuracy.levels[6].error.count, 0u);
  ASSERT_FALSE(accuracy.failures.empty());
  EXPECT_NE(accuracy.failures[0].find("thrower"), std::string::npos);
}

}  // namespace
}  // namespace psygen::synthesis
