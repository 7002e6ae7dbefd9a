// What `psygen calibrate` found, as text, JSON and a page with plots. Pure.
#pragma once

#include <string>

#include "engine/synthesis/cost_curves.hpp"

namespace psygen::cli {

// What `psygen calibrate` found.
struct Calibration {
  std::string world;  // whose models were fitted; empty: parameters drawn from all usual ranges
  synthesis::CalibrationReport fits;
  std::vector<synthesis::CostCurve> curves;
  synthesis::Accuracy held_out;
  std::size_t held_out_sets = 0;  // of each type
  double seconds = 0;
};

// As a table for the terminal, as JSON, and as a page of HTML with plots.
std::string calibration_text(const Calibration& found, const models::Registry& registry);
std::string calibration_json(const Calibration& found, const models::Registry& registry);
std::string calibration_page(const Calibration& found, const models::Registry& registry);

}  // namespace psygen::cli
