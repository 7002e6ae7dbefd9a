#include "engine/synthesis/cost_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/synthesis/fake_models.hpp"

namespace psygen::synthesis {
namespace {
using testing::FakeModel;
using testing::parameters_of;
using testing::registry_of;

// A clock that models advance: each synthesis takes the time of its formula.
struct VirtualTime {
  double now = 0;
  std::uint64_t calls = 0;
  double seconds_per_vertex = 1e-6;
  double seconds_fixed = 0;

  models::Registry registry() {
    return registry_of(std::make_unique<testing::ScriptedModel>(
        "timed", [this](const models::Parameters& p, int level) {
          ++calls;
          now += seconds_fixed + seconds_per_vertex * static_cast<double>(p.integer(1) >> level);
        }));
  }
  CalibrationOptions options(double limit = 0.4) {
    CalibrationOptions o;
    o.seconds_limit = limit;
    o.wall_clock = o.cpu_clock = [this] { return now; };
    return o;
  }
};

std::vector<CostSample> samples_of(std::initializer_list<std::int64_t> vertices) {
  std::vector<CostSample> samples;
  for (const std::int64_t n : vertices)
    samples.push_back({0, parameters_of(1, n)});
  return samples;
}

TEST(CostModel, CalibrationFindsTheConstantOfALinearCost) {
  VirtualTime time;
  const models::Registry registry = time.registry();
  CostModel cost(registry);
  const auto samples = samples_of({32, 64, 128, 256});
  const CalibrationReport report = cost.calibrate(samples, time.options());
  EXPECT_NEAR(cost.predict(0, parameters_of(1, 1000), 0), 1e-3, 1e-9);
  EXPECT_NEAR(cost.predict(0, parameters_of(1, 1000), 2), 0.25e-3, 1e-9);
  EXPECT_NEAR(report.fit_error_percent_p95, 0, 1e-6);
  EXPECT_EQ(report.levels.size(), 3u);
  for (const LevelCalibration& level : report.levels)
    EXPECT_EQ(level.samples, 4u);
}

TEST(CostModel, FindsTheFixedTimeOfEverySynthesis) {
  VirtualTime time;
  time.seconds_fixed = 200e-6;  // not part of the formula
  const models::Registry registry = time.registry();
  CostModel cost(registry);
  const CalibrationReport report =
      cost.calibrate(samples_of({8, 64, 256, 512, 1024}), time.options());
  EXPECT_LT(report.fit_error_percent_p95, 1e-3);
  EXPECT_NEAR(cost.predict(0, parameters_of(1, 200), 0), 400e-6, 1e-9);
}

TEST(CostModel, CoversWorkOfAboutTheSizeMeasuredAtThisLevel) {
  VirtualTime time;
  const models::Registry registry = time.registry();
  CostModel cost(registry);
  const auto covers = [&](std::int64_t vertices, int level) {
    return cost.covers(0, level, cost.work(0, parameters_of(1, vertices), level));
  };
  EXPECT_FALSE(covers(64, 0));
  cost.calibrate(samples_of({64, 256}), time.options());
  for (const std::int64_t vertices : {56, 64, 100, 256, 300})
    EXPECT_TRUE(covers(vertices, 0)) << vertices;
  for (const std::int64_t vertices : {16, 40, 400, 4096})
    EXPECT_FALSE(covers(vertices, 0)) << vertices;
  EXPECT_TRUE(covers(100, 2));
  EXPECT_FALSE(cost.covers(0, -1, {64, 64, 64}));
  EXPECT_FALSE(cost.covers(0, 3, {64, 64, 64}));
  EXPECT_FALSE(cost.covers(1, 0, {64, 64, 64}));
}

TEST(CostModel, ALevelWithTheFitOfACoarserOneCoversNothing) {
  VirtualTime time;
  time.seconds_per_vertex = 1e-3;
  const models::Registry registry = time.registry();
  CostModel cost(registry);
  const auto samples = samples_of({4096});
  cost.calibrate(samples, time.options(5));  // one synthesis of its finest level takes 4 s
  EXPECT_TRUE(cost.covers(0, 2, cost.work(0, samples[0].parameters, 2)));
  EXPECT_FALSE(cost.covers(0, 0, cost.work(0, samples[0].parameters, 0)));
}

TEST(CostModel, AWrongFormulaIsReportedAsFitError) {
  VirtualTime time;
  time.seconds_fixed = 200e-6;
  const models::Registry registry = time.registry();
  CostModel cost(registry);
  // Too few samples to separate the fixed part from the formula.
  const CalibrationReport report = cost.calibrate(samples_of({8, 64, 512}), time.options());
  EXPECT_GT(report.fit_error_percent_p95, 20);
}

TEST(CostModel, CalibrationStaysWithinItsLimit) {
  VirtualTime time;
  time.seconds_per_vertex = 1e-3;  // the full level of the largest sample alone takes 4 s
  const models::Registry registry = time.registry();
  CostModel cost(registry);
  const CalibrationReport report = cost.calibrate(samples_of({16, 64, 4096}), time.options(0.4));
  EXPECT_LE(report.seconds, 0.4);
  EXPECT_GT(report.measurements, 0u);
  // Skipped levels are predicted from the measured levels and samples.
  EXPECT_NEAR(cost.predict(0, parameters_of(1, 4096), 0), 4.096, 1e-6);
}

TEST(CostModel, AModelFarSlowerThanExpectedEndsItsMeasurementsAfterOne) {
  VirtualTime time;
  time.seconds_fixed = 3;
  const models::Registry registry = time.registry();
  CostModel cost(registry);
  const CalibrationReport report = cost.calibrate({}, time.options(0.4));
  EXPECT_EQ(time.calls, 1u);
  EXPECT_NEAR(report.seconds, 3, 1e-3);
}

TEST(CostModel, RealCalibrationWithoutSamplesUsesDefaultsAndReportsProgress) {
  models::Registry registry;
  ASSERT_TRUE(registry.add(std::make_unique<FakeModel>("a")));
  ASSERT_TRUE(registry.add(std::make_unique<FakeModel>("b")));
  CostModel cost(registry);
  std::vector<double> progress;
  const CalibrationReport report =
      cost.calibrate({}, {}, [&](double fraction) { progress.push_back(fraction); });
  EXPECT_EQ(report.levels.size(), 6u);
  EXPECT_TRUE(report.failures.empty());
  ASSERT_EQ(progress.size(), 6u);
  EXPECT_TRUE(std::is_sorted(progress.begin(), progress.end()));
  EXPECT_EQ(progress.back(), 1.0);
  EXPECT_GT(cost.predict(1, parameters_of(1, 1000), 0), 0);
}

TEST(CostModel, TypesThatMisbehaveAreNamedAndDoNotStopTheOthers) {
  models::Registry registry;
  ASSERT_TRUE(registry.add(std::make_unique<testing::ScriptedModel>(
      "thrower", [](const models::Parameters&, int) { throw std::runtime_error("no"); })));
  ASSERT_TRUE(registry.add(std::make_unique<testing::SizelessModel>()));
  ASSERT_TRUE(registry.add(std::make_unique<testing::LyingModel>()));
  ASSERT_TRUE(registry.add(std::make_unique<FakeModel>("good")));
  CostModel cost(registry);
  const CalibrationReport report = cost.calibrate();
  EXPECT_EQ(report.failures.size(), 9u);  // three types, three levels each
  EXPECT_NE(report.failures[0].find("thrower level 2 threw: no"), std::string::npos);
  EXPECT_GT(report.levels.back().samples, 0u);
  for (models::ModelIndex model = 0; model < 5; ++model) {
    const double seconds = cost.predict(model, parameters_of(1, 100), 7);
    EXPECT_TRUE(std::isfinite(seconds) && seconds > 0) << model;
  }
}

// Predicted cost of a request for a mesh of 100 vertices.
RequestCost request_of(const CostModel& cost, int level) {
  return cost.predict_request(0, level, cost.work(0, parameters_of(1, 100), level));
}

TEST(CostModel, ObservationsCorrectRequestsAndKeepTheCurve) {
  const models::Registry registry = registry_of(std::make_unique<FakeModel>());
  CostModel cost(registry);
  const auto p = parameters_of(1, 100);
  const double curve = cost.predict(0, p, 0), coarser = cost.predict(0, p, 1);
  EXPECT_EQ(request_of(cost, 0).warm_s(), curve);
  const double truth = curve * 3;
  for (int i = 0; i < 500; ++i)
    cost.observe(0, 0, cost.work(0, p, 0), Warmth::kWarm, truth);
  EXPECT_NEAR(request_of(cost, 0).warm_s() / truth, 1, 0.01);
  EXPECT_EQ(request_of(cost, 1).warm_s(), coarser);  // other levels keep their predictions
  EXPECT_EQ(cost.predict(0, p, 0), curve);
}

TEST(CostModel, TheCostOfColdCachesIsSharedByTypesThatRunTheSameCode) {
  models::Registry registry;
  ASSERT_TRUE(registry.add(std::make_unique<FakeModel>("a")));
  ASSERT_TRUE(registry.add(std::make_unique<FakeModel>("b")));
  ASSERT_TRUE(registry.add(std::make_unique<testing::LyingModel>()));
  CostModel cost(registry);
  EXPECT_EQ(cost.code_of(0), cost.code_of(1));
  EXPECT_NE(cost.code_of(0), cost.code_of(2));
  const Work work = cost.work(0, parameters_of(1, 100), 0);
  for (int i = 0; i < 100; ++i)
    cost.observe(0, 0, work, Warmth::kCold, cost.predict_from(0, 0, work) + 20e-6);
  const auto added = [&](models::ModelIndex model) {
    const RequestCost request = cost.predict_request(model, 0, work);
    return request.of(Warmth::kCold) - request.warm_s();
  };
  EXPECT_NEAR(added(0), 20e-6, 1e-6);
  EXPECT_NEAR(added(1), 20e-6, 1e-6);
  EXPECT_EQ(added(2), 0);
}

TEST(CostModel, ARequestIncludesReadingTheClock) {
  VirtualTime time;
  const models::Registry registry = time.registry();
  CostModel cost(registry);
  CalibrationOptions options = time.options();
  options.cpu_clock = [&time] { return time.now += 1e-6; };
  cost.calibrate(samples_of({4000, 8000}), options);
  const Work work = cost.work(0, parameters_of(1, 5000), 0);
  EXPECT_NEAR(cost.predict_request(0, 0, work).warm_s() - cost.predict_from(0, 0, work), 1e-6,
              1e-9);
}

TEST(CostModel, InvalidObservationsAreIgnored) {
  const models::Registry registry = registry_of(std::make_unique<FakeModel>());
  CostModel cost(registry);
  const double before = request_of(cost, 0).warm_s();
  cost.observe(5, 0, {1, 0, 0}, Warmth::kWarm, 1);
  cost.observe(0, -1, {1, 0, 0}, Warmth::kWarm, 1);
  cost.observe(0, 99, {1, 0, 0}, Warmth::kWarm, 1);
  cost.observe(0, 0, {0, 0, 0}, Warmth::kWarm, 1);
  cost.observe(0, 0, {1, 0, 0}, Warmth::kWarm, std::nan(""));
  EXPECT_EQ(request_of(cost, 0).warm_s(), before);
}

// Reports its own steps; `steps` may be any number.
class SteppingModel : public FakeModel {
 public:
  explicit SteppingModel(double steps) : steps_(steps) {}
  double steps(const models::Parameters&, int level) const override { return steps_ + level; }

 private:
  double steps_;
};

TEST(CostModel, UsesTheStepsOfATypeOrTheTrianglesOfItsFullDetail) {
  const models::Parameters p = parameters_of(1, 80);
  const auto steps_of = [&p](double steps, int level) {
    const models::Registry registry = registry_of(std::make_unique<SteppingModel>(steps));
    std::optional<models::MeshSize> size;
    const Work work = CostModel(registry).work(0, p, level, &size);
    EXPECT_TRUE(size && *size == registry[0].mesh_size(p, level));
    EXPECT_EQ(work.triangles, registry[0].mesh_size(p, level).triangle_count());
    return work.steps;
  };
  EXPECT_EQ(steps_of(500, 1), 501);
  EXPECT_EQ(steps_of(-1, 0), 80) << "equal to the triangles";
  EXPECT_EQ(steps_of(-1, 1), 80);
  EXPECT_EQ(steps_of(std::nan(""), 2), 80);
}

// Declares the duration of its steps.
class TimedModel : public FakeModel {
 public:
  explicit TimedModel(double step_s) : step_s_(step_s) {}
  double step_seconds() const override { return step_s_; }

 private:
  double step_s_;
};

TEST(CostModel, BeforeCalibrationTypesDeclareTheCostOfTheirSteps) {
  const auto seconds_of = [](double step_s) {
    const models::Registry registry = registry_of(std::make_unique<TimedModel>(step_s));
    return CostModel(registry).predict(0, parameters_of(1, 1000), 0);
  };
  EXPECT_NEAR(seconds_of(1e-6) - seconds_of(0), 1e-3, 1e-9);
  EXPECT_EQ(seconds_of(std::nan("")), seconds_of(FakeModel().step_seconds()));
  EXPECT_EQ(seconds_of(-1), seconds_of(FakeModel().step_seconds()));
}

TEST(CostModel, QuantilesInterpolateLinearly) {
  std::vector<double> values{4, 1, 3, 2};
  EXPECT_DOUBLE_EQ(quantile(values, 0.0), 1);
  EXPECT_DOUBLE_EQ(quantile(values, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile(values, 1.0), 4);
  EXPECT_DOUBLE_EQ(quantile({}, 0.5), 0);
}

}  // namespace
}  // namespace psygen::synthesis
