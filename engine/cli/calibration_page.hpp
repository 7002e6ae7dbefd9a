// Results of `psygen calibrate` as text, as JSON and as a page with plots. Pure.
#pragma once

#include <string>

#include "engine/synthesis/cost_curves.hpp"

namespace psygen::cli {

// Results of `psygen calibrate`.
struct Calibration {
  std::string world;  // name of the fitted world; empty: parameters drawn from all soft ranges
  synthesis::CalibrationReport fits;
  std::vector<synthesis::CostCurve> curves;
  synthesis::Accuracy held_out;
  std::size_t held_out_sets = 0;  // of each type
  double seconds = 0;
};

// Formats the results as a table for the terminal, as JSON, and as an HTML page with plots.
std::string calibration_text(const Calibration& found, const models::Registry& registry);
std::string calibration_json(const Calibration& found, const models::Registry& registry);
std::string calibration_page(const Calibration& found, const models::Registry& registry);

}  // namespace psygen::cli
