#include "engine/cli/calibration_page.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace psygen::cli {
namespace {

// Terrain and rocks were measured; trees were not.
Calibration partly_measured() {
  Calibration found;
  found.fits.levels = {{0, 0, {}, 1.5, 4}, {2, 0, {}, 0, 0}};
  found.held_out.levels = {{0, 0, {4, 2.5, 3.5}}, {1, 0, {9, 7.5, 31.5}}, {2, 0, {}}};
  found.held_out.all = {13, 4.5, 20.5};
  found.held_out.worst = {1, {9, 7.5, 31.5}};
  found.fits.failures = {"tree level 0 threw: no"};
  return found;
}

TEST(CalibrationPage, UnmeasuredTypesHaveNoError) {
  const models::Registry registry = models::make_standard_registry();
  const Calibration found = partly_measured();
  const std::string text = calibration_text(found, registry);
  EXPECT_NE(text.find("level 0  not measured"), std::string::npos) << text;
  EXPECT_EQ(text.find(" 0.0"), std::string::npos) << text;
  EXPECT_NE(calibration_page(found, registry).find("not measured"), std::string::npos);
  const auto json = nlohmann::json::parse(calibration_json(found, registry));
  const auto& tree = json["held_out"]["levels"][2];
  EXPECT_EQ(tree["error_percent"]["measured"], 0);
  EXPECT_TRUE(tree["error_percent"]["p50"].is_null());
  EXPECT_TRUE(tree["error_percent"]["p95"].is_null());
  EXPECT_TRUE(json["fits"][1]["error_percent_p50"].is_null());
  EXPECT_EQ(json["held_out"]["levels"][0]["error_percent"]["p95"], 3.5);
  EXPECT_EQ(json["failures"][0], "tree level 0 threw: no");
}

std::size_t count(const std::string& text, const std::string& words) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(words, at)) != std::string::npos; ++at)
    ++found;
  return found;
}

TEST(CalibrationPage, TheCostModelIsDrawnOnlyWhereItWasCalibrated) {
  const models::Registry registry = models::make_standard_registry();
  Calibration found = partly_measured();
  found.world = "paper";
  const auto point = [](double value, std::optional<double> predicted) {
    return synthesis::CurvePoint{value, 1e-6 * value, value, predicted};
  };
  found.curves = {{0, "size", {point(1, 2e-6), point(2, 3e-6)}, {}},
                  {1, "subdivisions", {point(1, {}), point(2, 1e-6), point(3, {})}, {}},
                  {2, "iterations", {point(1, {}), point(2, {})}, {}},
                  {2, "branches", {}, {}}};
  const std::string page = calibration_page(found, registry);
  EXPECT_EQ(count(page, "cost model</span>"), 2u);  // the legends of the first two plots
  EXPECT_EQ(count(page, "class=\"ring stroke3"), 1u);
  EXPECT_EQ(count(page, "The cost model is calibrated with models of the world paper.<"), 1u);
  EXPECT_EQ(count(page, "drawn where their size is similar"), 1u);
  EXPECT_EQ(count(page, "No cost model: no sample of this type for calibration."), 1u);
  EXPECT_EQ(count(page, "Not measured: synthesis failed or the time limit was reached."), 1u);
  const auto json = nlohmann::json::parse(calibration_json(found, registry));
  EXPECT_TRUE(json["curves"][1]["points"][0]["predicted_seconds"].is_null());
  EXPECT_EQ(json["curves"][1]["points"][1]["predicted_seconds"], 1e-6);
  EXPECT_TRUE(json["curves"][3]["r_squared"].is_null());
}

TEST(CalibrationPage, UncalibratedLevelsHaveNoFormulaOfTheirTime) {
  const models::Registry registry = models::make_standard_registry();
  Calibration found = partly_measured();
  found.fits.levels[0].fit = {.fixed_s = 1e-6, .per_step_s = 2e-9};
  found.fits.levels[1].fit = {.per_operation_s = 5e-9};  // the guess for an unknown level
  const std::string page = calibration_page(found, registry);
  EXPECT_NE(page.find("<td>1 µs + 2 ns · steps</td>"), std::string::npos) << page;
  EXPECT_NE(page.find("tree level 0</th><td>not calibrated</td>"), std::string::npos) << page;
  const auto json = nlohmann::json::parse(calibration_json(found, registry));
  EXPECT_EQ(json["fits"][0]["seconds_per_step"], 2e-9);
  EXPECT_TRUE(json["fits"][1]["seconds_per_operation"].is_null());
}

TEST(CalibrationPage, EscapesTheNameOfTheWorld) {
  const models::Registry registry = models::make_standard_registry();
  Calibration found = partly_measured();
  found.world = "<b>&";
  found.curves = {{0, "size", {{1, 1e-6, 1, 1e-6}}, {}}};
  const std::string page = calibration_page(found, registry);
  EXPECT_EQ(page.find("<b>&"), std::string::npos);
  EXPECT_EQ(count(page, "&lt;b&gt;&amp;"), 3u);  // title, heading, note
}

TEST(CalibrationPage, TheWorstTypeIsListedNextToAll) {
  const models::Registry registry = models::make_standard_registry();
  const Calibration found = partly_measured();
  const std::string text = calibration_text(found, registry);
  EXPECT_NE(text.find("rock     worst    p50   7.5  p95  31.5  of 9\n  all"), std::string::npos)
      << text;
  EXPECT_NE(calibration_page(found, registry).find("the worst type is rock"), std::string::npos);
  const auto json = nlohmann::json::parse(calibration_json(found, registry));
  EXPECT_EQ(json["held_out"]["worst_model"]["model"], "rock");
  EXPECT_EQ(json["held_out"]["worst_model"]["error_percent"]["p95"], 31.5);
}

}  // namespace
}  // namespace psygen::cli
