#include "game/calibration_page.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace psygen::game {
namespace {

// Terrain and rocks were measured, trees were not.
Calibration partly_measured() {
  Calibration found;
  found.fits.levels = {{0, 0, {}, 1.5, 4}, {2, 0, {}, 0, 0}};
  found.held_out.levels = {{0, 0, {4, 2.5, 3.5}}, {1, 0, {9, 7.5, 31.5}}, {2, 0, {}}};
  found.held_out.all = {13, 4.5, 20.5};
  found.held_out.worst = {1, {9, 7.5, 31.5}};
  found.fits.failures = {"tree level 0 threw: no"};
  return found;
}

TEST(CalibrationPage, WhatWasNotMeasuredHasNoError) {
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

TEST(CalibrationPage, TheWorstTypeStandsNextToAll) {
  const models::Registry registry = models::make_standard_registry();
  const Calibration found = partly_measured();
  const std::string text = calibration_text(found, registry);
  EXPECT_NE(text.find("rock     worst    p50   7.5  p95  31.5  of 9\n  all"), std::string::npos)
      << text;
  EXPECT_NE(calibration_page(found, registry).find("worst for rock"), std::string::npos);
  const auto json = nlohmann::json::parse(calibration_json(found, registry));
  EXPECT_EQ(json["held_out"]["worst_model"]["model"], "rock");
  EXPECT_EQ(json["held_out"]["worst_model"]["error_percent"]["p95"], 31.5);
}

}  // namespace
}  // namespace psygen::game
