#include "engine/synthesis/cost_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "engine/core/hash.hpp"

namespace psygen::synthesis {
namespace {

CostFit line(double fixed_s, double per_operation_s, double per_triangle_s, double per_step_s) {
  CostFit fit;
  fit.fixed_s = fixed_s;
  fit.per_operation_s = per_operation_s;
  fit.per_triangle_s = per_triangle_s;
  fit.per_step_s = per_step_s;
  return fit;
}

// Measurements of a known line over random work, with a relative error of up to `noise`.
std::vector<Measurement> measured(const CostFit& truth, std::size_t count, double noise = 0) {
  core::RandomStream random(3, 0, 0, 0, core::Purpose::kParameters);
  std::vector<Measurement> result;
  for (std::size_t i = 0; i < count; ++i) {
    const Work work{std::exp(random.next_real(0, 7)), std::exp(random.next_real(3, 9)),
                    std::exp(random.next_real(5, 9))};
    result.push_back({work, truth.seconds(work) * (1 + random.next_real(-noise, noise))});
  }
  return result;
}

void expect_near(const CostFit& fit, const CostFit& truth, double relative) {
  EXPECT_NEAR(fit.fixed_s, truth.fixed_s, relative * truth.fixed_s + 1e-15);
  EXPECT_NEAR(fit.per_operation_s, truth.per_operation_s, relative * truth.per_operation_s + 1e-15);
  EXPECT_NEAR(fit.per_triangle_s, truth.per_triangle_s, relative * truth.per_triangle_s + 1e-15);
  EXPECT_NEAR(fit.per_step_s, truth.per_step_s, relative * truth.per_step_s + 1e-15);
}

TEST(CostFit, FindsEveryPossibleLine) {
  for (const CostFit& truth :
       {line(2e-6, 3e-8, 4e-9, 0), line(0, 3e-8, 4e-9, 0), line(2e-6, 0, 4e-9, 0),
        line(2e-6, 3e-8, 0, 0), line(2e-6, 0, 0, 0), line(1e-6, 0, 0, 3e-9),
        line(1e-6, 2e-8, 3e-9, 4e-9), line(0, 3e-8, 0, 0), line(0, 0, 4e-9, 0)}) {
    expect_near(fit_cost(measured(truth, 20)), truth, 1e-6);
  }
}

TEST(CostFit, IgnoresAFewDisturbedMeasurements) {
  const CostFit truth = line(2e-6, 3e-8, 4e-9, 0);
  auto measurements = measured(truth, 40, 0.02);
  for (std::size_t i = 0; i < 4; ++i)
    measurements[i * 9].seconds *= 5;
  const CostFit fit = fit_cost(measurements);
  for (const Measurement& m : measured(truth, 100))
    EXPECT_NEAR(fit.seconds(m.work) / m.seconds, 1, 0.05);
}

TEST(CostFit, BendsWhereTimeIsNotProportionalToWork) {
  // Time grows with the logarithm of the size: no line describes it.
  core::RandomStream random(4, 0, 0, 0, core::Purpose::kParameters);
  std::vector<Measurement> measurements;
  for (int i = 0; i < 200; ++i) {
    const double size = std::exp2(random.next_real(8, 15));
    measurements.push_back({{1, 12, size}, 1e-6 * (std::log2(size) - 7)});
  }
  const CostFit fit = fit_cost(std::span(measurements).first(64));
  for (const Measurement& m : measurements)
    EXPECT_NEAR(fit.seconds(m.work) / m.seconds, 1, 0.25);
  EXPECT_GT(std::abs(fit.line_seconds(measurements[0].work) / measurements[0].seconds - 1), 0.01);
}

TEST(CostFit, HasNoTermBelowZero) {
  // Seconds decrease as operations grow: only the fixed part remains.
  std::vector<Measurement> measurements;
  for (int i = 1; i < 10; ++i)
    measurements.push_back({{static_cast<double>(i), 10.0, 10.0}, 1e-6 * (20 - i)});
  const CostFit fit = fit_cost(measurements);
  EXPECT_GE(fit.fixed_s, 0);
  EXPECT_GE(fit.per_operation_s, 0);
  EXPECT_GE(fit.per_triangle_s, 0);
  EXPECT_GT(fit.seconds({5, 10, 10}), 5e-6);
}

TEST(CostFit, UsesTheFormulaAloneForFewMeasurements) {
  const CostFit fit = fit_cost(measured(line(2e-6, 3e-8, 4e-9, 0), 3));
  EXPECT_EQ(fit.fixed_s, 0);
  EXPECT_EQ(fit.per_triangle_s, 0);
  EXPECT_GT(fit.per_operation_s, 0);
  EXPECT_EQ(fit_cost({}).seconds({1, 1, 1}), 0);
}

TEST(CostFit, FitsIdenticalModels) {
  const std::vector<Measurement> same(8, {{100, 50, 50}, 1e-5});
  EXPECT_NEAR(fit_cost(same).seconds({100, 50, 50}), 1e-5, 1e-12);
}

TEST(FormulaFit, ExplainsTimesThatFollowTheFormulaAndFewOthers) {
  std::vector<Measurement> exact, other;
  for (int i = 1; i <= 6; ++i) {
    const double x = i * std::pow(4, i - 1);
    exact.push_back({{x, 0, 0}, 7e-8 * x});
    other.push_back({{x, 0, 0}, 1e-6 * (7 - i)});
  }
  EXPECT_NEAR(fit_formula(exact).seconds_per_operation, 7e-8, 1e-15);
  EXPECT_NEAR(fit_formula(exact).r_squared, 1, 1e-12);
  EXPECT_LT(fit_formula(other).r_squared, 0.5);
  EXPECT_EQ(fit_formula({}).seconds_per_operation, 0);
}

TEST(FormulaFit, FindsAFixedTimeBesidesTheFormula) {
  std::vector<Measurement> measured;
  for (int i = 1; i <= 6; ++i)
    measured.push_back({{1e3 * i, 0, 0}, 4e-5 + 2e-9 * 1e3 * i});
  const FormulaFit fit = fit_formula(measured);
  EXPECT_LT(fit.r_squared, 0);  // a constant explains more
  EXPECT_NEAR(fit.fixed_s, 4e-5, 1e-12);
  EXPECT_NEAR(fit.seconds_per_operation_above, 2e-9, 1e-16);
  EXPECT_NEAR(fit.r_squared_above, 1, 1e-9);
  // A single value of the parameter says nothing about its effect.
  const FormulaFit one = fit_formula(std::span(measured).first(1));
  EXPECT_EQ(one.seconds_per_operation_above, 0);
  EXPECT_NEAR(one.fixed_s, measured[0].seconds, 1e-15);
}

}  // namespace
}  // namespace psygen::synthesis
