#include "game/calibration_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "engine/models/species.hpp"
#include "engine/telemetry/curve_plot.hpp"
#include "engine/telemetry/report_plot.hpp"
#include "engine/telemetry/report_style.hpp"

namespace psygen::game {
namespace {

using Json = nlohmann::ordered_json;

// The paper's formulas (equations 1, 3 and 4), as what complexity() computes. That of a species is
// the mean number of branches that its grammar grows.
std::string formula_of(const models::ModelType& type) {
  if (type.name() == "rock") return "c·n·4^(n−1)";
  if (type.name() == "terrain") return "c·m·n²";
  if (type.name() == "tree") return "c·mⁿ";
  if (type.name() == "grass") return "c·blades";
  return models::is_species_type(type) ? "c·branches" : "c·complexity";
}

// Of the column that names models.
std::size_t name_width(const models::Registry& registry) {
  std::size_t width = 8;
  for (std::size_t i = 0; i < registry.size(); ++i)
    width = std::max(width, registry[static_cast<models::ModelIndex>(i)].name().size());
  return width;
}

std::string seconds_text(double seconds) {
  const double size = std::abs(seconds);
  if (size < 1e-6) return fmt::format("{:.3g} ns", seconds * 1e9);
  if (size < 1e-3) return fmt::format("{:.3g} µs", seconds * 1e6);
  return fmt::format("{:.3g} ms", seconds * 1e3);
}

std::string fit_text(const synthesis::CostFit& fit) {
  return fmt::format("{} + {}·operations + {}·triangles + {}·steps", seconds_text(fit.fixed_s),
                     seconds_text(fit.per_operation_s), seconds_text(fit.per_triangle_s),
                     seconds_text(fit.per_step_s));
}

Json error_json(const synthesis::CostError& error) {
  if (error.count == 0) return {{"measured", 0}, {"p50", nullptr}, {"p95", nullptr}};
  return {{"measured", error.count}, {"p50", error.p50_percent}, {"p95", error.p95_percent}};
}

std::string error_text(const synthesis::CostError& error) {
  if (error.count == 0) return "not measured";
  return fmt::format("p50 {:>5.1f}  p95 {:>5.1f}  of {}", error.p50_percent, error.p95_percent,
                     error.count);
}

// Of the page's first sentence.
std::string worst_text(const Calibration& found, const models::Registry& registry) {
  if (!found.held_out.worst) return "";
  return fmt::format("; worst for {}: {}",
                     telemetry::escaped(registry[found.held_out.worst->model].name()),
                     error_text(found.held_out.worst->error));
}

// [log2 of 1 + steps, factor] of each knot.
Json correction_json(const synthesis::CostFit& fit) {
  auto knots = Json::array();
  for (std::size_t k = 0; k < fit.knot_count; ++k)
    knots.push_back({fit.knots[k].log2_size, fit.knots[k].factor});
  return knots;
}

Json curve_json(const synthesis::CostCurve& curve, const models::Registry& registry) {
  auto points = Json::array();
  for (const synthesis::CurvePoint& point : curve.points) {
    points.push_back({{"value", point.value},
                      {"operations", point.operations},
                      {"seconds", point.seconds},
                      {"predicted_seconds", point.predicted_s}});
  }
  const models::ModelType& type = registry[curve.model];
  return {{"model", type.name()},
          {"parameter", curve.parameter},
          {"formula", formula_of(type)},
          {"c_seconds", curve.formula.seconds_per_operation},
          {"r_squared", curve.formula.r_squared},
          {"with_fixed",
           {{"a_seconds", curve.formula.fixed_s},
            {"c_seconds", curve.formula.seconds_per_operation_above},
            {"r_squared", curve.formula.r_squared_above}}},
          {"points", points}};
}

std::string plot_of(const synthesis::CostCurve& curve, const models::Registry& registry) {
  const models::ModelType& type = registry[curve.model];
  telemetry::CurvePlot plot;
  plot.title = fmt::format("{}: time over {}", type.name(), curve.parameter);
  plot.x_name = curve.parameter;
  plot.unit = "µs";
  plot.note =
      fmt::format("c = {}, R² = {:.4f}; above a = {} R² = {:.4f}",
                  seconds_text(curve.formula.seconds_per_operation), curve.formula.r_squared,
                  seconds_text(curve.formula.fixed_s), curve.formula.r_squared_above);
  plot.curves = {{formula_of(type), 2, telemetry::CurveKind::kLine, {}},
                 {"cost model", 3, telemetry::CurveKind::kLine, {}},
                 {"measured", 1, telemetry::CurveKind::kPoints, {}}};
  for (const synthesis::CurvePoint& point : curve.points) {
    plot.x.push_back(point.value);
    plot.curves[0].values.push_back(curve.formula.seconds_per_operation * point.operations * 1e6);
    plot.curves[1].values.push_back(point.predicted_s * 1e6);
    plot.curves[2].values.push_back(point.seconds * 1e6);
  }
  return telemetry::curve_plot_html(plot);
}

}  // namespace

std::string calibration_text(const Calibration& found, const models::Registry& registry) {
  std::string text =
      "time over a parameter, level 0: c times the formula, and the same above a fixed time a\n";
  const auto out = std::back_inserter(text);
  const std::size_t width = name_width(registry);
  for (const synthesis::CostCurve& curve : found.curves) {
    const models::ModelType& type = registry[curve.model];
    const synthesis::FormulaFit& f = curve.formula;
    fmt::format_to(
        out, "  {:<{}} {:<13} {:<13} c = {:<9} R² = {:.4f}; a = {:<9} c = {:<9} R² = {:.4f}\n",
        type.name(), width, curve.parameter, formula_of(type),
        seconds_text(f.seconds_per_operation), f.r_squared, seconds_text(f.fixed_s),
        seconds_text(f.seconds_per_operation_above), f.r_squared_above);
  }
  fmt::format_to(out, "error of predictions for {} other parameter sets of each type, in %\n",
                 found.held_out_sets);
  for (const synthesis::LevelAccuracy& level : found.held_out.levels) {
    fmt::format_to(out, "  {:<{}} level {}  {}\n", registry[level.model].name(), width, level.level,
                   error_text(level.error));
  }
  if (found.held_out.worst) {
    fmt::format_to(out, "  {:<{}} worst    {}\n", registry[found.held_out.worst->model].name(),
                   width, error_text(found.held_out.worst->error));
  }
  fmt::format_to(out, "  {:<{}}  {}\n", "all", width + 8, error_text(found.held_out.all));
  return text;
}

std::string calibration_json(const Calibration& found, const models::Registry& registry) {
  Json json;
  json["curves"] = Json::array();
  for (const synthesis::CostCurve& curve : found.curves)
    json["curves"].push_back(curve_json(curve, registry));
  json["fits"] = Json::array();
  for (const synthesis::LevelCalibration& level : found.fits.levels) {
    json["fits"].push_back(
        {{"model", registry[level.model].name()},
         {"level", level.level},
         {"fixed_seconds", level.fit.fixed_s},
         {"seconds_per_operation", level.fit.per_operation_s},
         {"seconds_per_triangle", level.fit.per_triangle_s},
         {"seconds_per_step", level.fit.per_step_s},
         {"correction", correction_json(level.fit)},
         {"samples", level.samples},
         {"error_percent_p50", level.samples > 0 ? Json(level.fit_error_percent) : Json(nullptr)}});
  }
  Json& held_out = json["held_out"];
  held_out["sets_of_each_model"] = found.held_out_sets;
  held_out["error_percent"] = error_json(found.held_out.all);
  held_out["worst_model"] = nullptr;
  if (found.held_out.worst) {
    held_out["worst_model"] = {{"model", registry[found.held_out.worst->model].name()},
                               {"error_percent", error_json(found.held_out.worst->error)}};
  }
  held_out["levels"] = Json::array();
  for (const synthesis::LevelAccuracy& level : found.held_out.levels) {
    held_out["levels"].push_back({{"model", registry[level.model].name()},
                                  {"level", level.level},
                                  {"error_percent", error_json(level.error)}});
  }
  json["failures"] = found.fits.failures;
  json["seconds"] = found.seconds;
  return json.dump(2) + "\n";
}

std::string calibration_page(const Calibration& found, const models::Registry& registry) {
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">";
  html += "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">";
  html += fmt::format("<title>psygen: what synthesis costs</title><style>{}",
                      telemetry::report_style());
  html +=
      ".plots { display:grid; grid-template-columns:repeat(auto-fit,minmax(420px,1fr)); gap:0 14px "
      "}";
  html += "</style></head><body><main>\n<h1>What synthesis costs</h1>\n";
  html += fmt::format(
      "<p class=\"lead\">Time of one core at full detail over each parameter of the paper's "
      "formulas. "
      "Error of predictions for {} other parameter sets of each type, all levels, in %: {}{}."
      "</p>\n<div class=\"plots\">\n",
      found.held_out_sets, error_text(found.held_out.all), worst_text(found, registry));
  for (const synthesis::CostCurve& curve : found.curves)
    html += plot_of(curve, registry);
  html += "</div>\n<div class=\"facts\"><section><h2>Cost model and error in %</h2><table>";
  for (std::size_t i = 0; i < found.held_out.levels.size(); ++i) {
    const synthesis::LevelAccuracy& level = found.held_out.levels[i];
    std::string fit;
    for (const synthesis::LevelCalibration& line : found.fits.levels) {
      if (line.model == level.model && line.level == level.level) fit = fit_text(line.fit);
    }
    fmt::format_to(std::back_inserter(html), "<tr><th>{} level {}</th><td>{}</td><td>{}</td></tr>",
                   telemetry::escaped(registry[level.model].name()), level.level, fit,
                   error_text(level.error));
  }
  return html + "</table></section></div>\n</main></body></html>\n";
}

}  // namespace psygen::game
