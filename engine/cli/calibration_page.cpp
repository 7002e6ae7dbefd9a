#include "engine/cli/calibration_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/models/tree/species.hpp"
#include "engine/telemetry/curve_plot.hpp"
#include "engine/telemetry/page.hpp"

namespace psygen::cli {
namespace {

using Json = nlohmann::ordered_json;

// Added to the style of reports. The table is wide: it scrolls in a narrow window.
constexpr std::string_view kStyle =
    ".plots { display:grid; gap:0 14px;"
    " grid-template-columns:repeat(auto-fit,minmax(min(420px,100%),1fr)) }\n"
    "@media (max-width:700px) { .plots figure { overflow-x:auto } .plots svg { min-width:420px } "
    "}\n"
    ".costs section { background:var(--card); border:1px solid var(--edge); border-radius:10px;"
    " margin-top:14px; padding:14px 16px; overflow-x:auto }\n"
    ".costs td { padding-left:14px; white-space:nowrap }\n";

// The paper's formulas (equations 1, 3 and 4), as complexity() computes them. The formula of a
// species is the mean number of branches that its grammar grows.
std::string formula_of(const models::ModelType& type) {
  if (type.name() == "rock") return "c·n·4^(n−1)";
  if (type.name() == "terrain") return "c·m·n²";
  if (type.name() == "tree") return "c·mⁿ";
  if (type.name() == "grass") return "c·blades";
  return models::is_species_type(type) ? "c·branches" : "c·complexity";
}

// Width of the column with model names.
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

// Formats the terms that are not zero.
std::string fit_text(const synthesis::CostFit& fit) {
  std::string text = fit.fixed_s > 0 ? seconds_text(fit.fixed_s) : "";
  const auto add = [&text](double seconds, std::string_view unit) {
    if (!(seconds > 0)) return;
    text += fmt::format("{}{} · {}", text.empty() ? "" : " + ", seconds_text(seconds), unit);
  };
  add(fit.per_operation_s, "operations");
  add(fit.per_triangle_s, "triangles");
  add(fit.per_step_s, "steps");
  return fit.knot_count > 0 ? text + ", bent by size" : text;
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

std::string error_sentence(const synthesis::CostError& error) {
  return fmt::format("{:.1f} % in the median, {:.1f} % at the 95th percentile of {}",
                     error.p50_percent, error.p95_percent, error.count);
}

// First paragraph of the page.
std::string lead_of(const Calibration& found, const models::Registry& registry) {
  std::string text =
      "Time of one core at full detail, plotted over each parameter of the paper's formulas. All "
      "other "
      "parameters have their defaults; types with a seed are averaged over several.";
  if (found.held_out.all.count == 0) return text + " No prediction was measured.";
  text += fmt::format(
      " The error of predictions for {} other parameter sets of each type, at all levels, is {}",
      found.held_out_sets, error_sentence(found.held_out.all));
  if (found.held_out.worst) {
    text +=
        fmt::format("; the worst type is {} with {}", registry[found.held_out.worst->model].name(),
                    error_sentence(found.held_out.worst->error));
  }
  return text + ".";
}

const synthesis::LevelCalibration* calibration_of(const Calibration& found,
                                                  models::ModelIndex model, int level) {
  for (const synthesis::LevelCalibration& line : found.fits.levels) {
    if (line.model == model && line.level == level) return &line;
  }
  return nullptr;
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
    points.push_back(
        {{"value", point.value},
         {"operations", point.operations},
         {"seconds", point.seconds},
         {"predicted_seconds", point.predicted_s ? Json(*point.predicted_s) : Json(nullptr)}});
  }
  const models::ModelType& type = registry[curve.model];
  const bool measured = !curve.points.empty();
  const auto known = [measured](double value) { return measured ? Json(value) : Json(nullptr); };
  return {{"model", type.name()},
          {"parameter", curve.parameter},
          {"formula", formula_of(type)},
          {"c_seconds", known(curve.formula.seconds_per_operation)},
          {"r_squared", known(curve.formula.r_squared)},
          {"with_fixed",
           {{"a_seconds", known(curve.formula.fixed_s)},
            {"c_seconds", known(curve.formula.seconds_per_operation_above)},
            {"r_squared", known(curve.formula.r_squared_above)}}},
          {"points", points}};
}

Json fit_json(const synthesis::LevelCalibration& level, const models::Registry& registry) {
  const bool measured = level.samples > 0;
  const auto known = [measured](const Json& value) { return measured ? value : Json(nullptr); };
  return {{"model", registry[level.model].name()},
          {"level", level.level},
          {"fixed_seconds", known(level.fit.fixed_s)},
          {"seconds_per_operation", known(level.fit.per_operation_s)},
          {"seconds_per_triangle", known(level.fit.per_triangle_s)},
          {"seconds_per_step", known(level.fit.per_step_s)},
          {"correction", known(correction_json(level.fit))},
          {"samples", level.samples},
          {"error_percent_p50", known(level.fit_error_percent)}};
}

// Caption of a plot: the constants of its formulas, and the range in which the cost model is drawn.
std::string note_of(const synthesis::CostCurve& curve, const Calibration& found,
                    const models::ModelType& type) {
  if (curve.points.empty()) return "Not measured: synthesis failed or the time limit was reached.";
  const synthesis::FormulaFit& f = curve.formula;
  const std::string formulas = fmt::format(
      "{}: c = {}, R² = {:.4f}. With a fixed time: a = {}, c = {}, R² = {:.4f}. ", formula_of(type),
      seconds_text(f.seconds_per_operation), f.r_squared, seconds_text(f.fixed_s),
      seconds_text(f.seconds_per_operation_above), f.r_squared_above);
  const auto predicted = std::count_if(
      curve.points.begin(), curve.points.end(),
      [](const synthesis::CurvePoint& point) { return point.predicted_s.has_value(); });
  const std::string from = found.world.empty() ? "the drawn parameter sets"
                                               : fmt::format("models of the world {}", found.world);
  if (predicted == static_cast<std::ptrdiff_t>(curve.points.size())) {
    return formulas + "The cost model is calibrated with " + from + ".";
  }
  if (predicted > 0) {
    return formulas + "The cost model is calibrated with " + from +
           " and drawn where their size is similar.";
  }
  const synthesis::LevelCalibration* fit = calibration_of(found, curve.model, 0);
  return formulas +
         (fit != nullptr && fit->samples > 0
              ? "No cost model in this range: " + from + " are larger or smaller than all of these."
              : std::string("No cost model: no sample of this type for calibration."));
}

std::string plot_of(const synthesis::CostCurve& curve, const Calibration& found,
                    const models::Registry& registry) {
  const models::ModelType& type = registry[curve.model];
  const synthesis::FormulaFit& f = curve.formula;
  telemetry::CurvePlot plot;
  plot.title = fmt::format("{}: time over {}", type.name(), curve.parameter);
  plot.x_name = curve.parameter;
  plot.unit = "µs";
  plot.note = note_of(curve, found, type);
  using enum telemetry::CurveKind;
  plot.curves = {{formula_of(type), 2, kLine, {}},
                 {"a + " + formula_of(type), 5, kDashed, {}},
                 {"cost model", 3, kLine, {}},
                 {"measured", 1, kPoints, {}}};
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  for (const synthesis::CurvePoint& point : curve.points) {
    plot.x.push_back(point.value);
    const std::array<double, 4> seconds = {
        f.seconds_per_operation * point.operations,
        f.fixed_s + f.seconds_per_operation_above * point.operations,
        point.predicted_s.value_or(kNothing), point.seconds};
    for (std::size_t i = 0; i < seconds.size(); ++i)
      plot.curves[i].values.push_back(seconds[i] * 1e6);
  }
  return telemetry::curve_plot_html(plot);
}

// Table row of one type at one level: its cost curve and the accuracy of predictions.
std::string accuracy_row(const synthesis::LevelAccuracy& level, const Calibration& found,
                         const models::Registry& registry) {
  const synthesis::LevelCalibration* line = calibration_of(found, level.model, level.level);
  const bool calibrated = line != nullptr && line->samples > 0;
  const std::string errors =
      level.error.count == 0
          ? "<td>not measured</td><td></td><td></td>"
          : fmt::format("<td>{:.1f}</td><td>{:.1f}</td><td>{}</td>", level.error.p50_percent,
                        level.error.p95_percent, level.error.count);
  return fmt::format("<tr><th>{} level {}</th><td>{}</td>{}</tr>\n",
                     telemetry::escaped(registry[level.model].name()), level.level,
                     calibrated ? telemetry::escaped(fit_text(line->fit)) : "not calibrated",
                     errors);
}

}  // namespace

std::string calibration_text(const Calibration& found, const models::Registry& registry) {
  std::string text =
      "time over a parameter, level 0: c times the formula, and a plus c times the formula\n";
  const auto out = std::back_inserter(text);
  const std::size_t width = name_width(registry);
  for (const synthesis::CostCurve& curve : found.curves) {
    const models::ModelType& type = registry[curve.model];
    const synthesis::FormulaFit& f = curve.formula;
    if (curve.points.empty()) {
      fmt::format_to(out, "  {:<{}} {:<13} {:<13} not measured\n", type.name(), width,
                     curve.parameter, formula_of(type));
      continue;
    }
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
  for (const synthesis::LevelCalibration& level : found.fits.levels)
    json["fits"].push_back(fit_json(level, registry));
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
  const std::string title =
      found.world.empty() ? "Cost of synthesis" : "Cost of synthesis: " + found.world;
  std::string html =
      fmt::format("<h1>{}</h1>\n<p class=\"lead\">{}</p>\n<div class=\"plots\">\n",
                  telemetry::escaped(title), telemetry::escaped(lead_of(found, registry)));
  for (const synthesis::CostCurve& curve : found.curves)
    html += plot_of(curve, found, registry);
  html +=
      "</div>\n<div class=\"costs\"><section><h2>Cost model and its error in %</h2><table>"
      "<tr><th>type</th><td>predicted time</td><td>p50</td><td>p95</td><td>measured</td></tr>\n";
  for (const synthesis::LevelAccuracy& level : found.held_out.levels)
    html += accuracy_row(level, found, registry);
  return telemetry::page_html("psygen: " + title, kStyle, html + "</table></section></div>\n");
}

}  // namespace psygen::cli
