#include "engine/models/model_type.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace psygen::models {
namespace {

std::string value_text(const ParameterSpec& spec, const Parameters& p, std::size_t i) {
  return spec.type == ParameterType::kInteger ? fmt::format("{}", p.integer(i))
                                              : fmt::format("{:g}", p.real(i));
}

// Returns for example "an integer from 4 to 128 vertices".
std::string allowed_text(const ParameterSpec& spec) {
  const bool has_unit = !spec.unit.empty() && spec.unit != "1";
  return fmt::format("{} from {:g} to {:g}{}{}",
                     spec.type == ParameterType::kInteger ? "an integer" : "a number",
                     spec.hard_min, spec.hard_max, has_unit ? " " : "", has_unit ? spec.unit : "");
}

}  // namespace

std::string predicted_cost_text(double log2_triangles) {
  if (!std::isfinite(log2_triangles)) return "predicted cost: unbounded";
  if (log2_triangles < 40)
    return fmt::format("predicted cost: {:.0f} triangles", std::exp2(log2_triangles));
  return fmt::format("predicted cost: 2^{:.1f} triangles", log2_triangles);
}

Parameters default_parameters(const ModelType& type) {
  Parameters p;
  const std::span<const ParameterSpec> specs = type.parameters();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    if (specs[i].type == ParameterType::kInteger) {
      p.set_integer(i, static_cast<std::int64_t>(specs[i].default_value));
    } else {
      p.set_real(i, specs[i].default_value);
    }
  }
  return p;
}

double parameter_number(const ModelType& type, const Parameters& p, std::size_t i) {
  return type.parameters()[i].type == ParameterType::kInteger ? static_cast<double>(p.integer(i))
                                                              : p.real(i);
}

int parameter_index(const ModelType& type, std::string_view name) {
  const std::span<const ParameterSpec> specs = type.parameters();
  const auto found = std::ranges::find(specs, name, &ParameterSpec::name);
  return found == specs.end() ? -1 : static_cast<int>(found - specs.begin());
}

core::Result<void> validate(const ModelType& type, const Parameters& p, double max_log2_cost) {
  const std::span<const ParameterSpec> specs = type.parameters();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    // An integer converts to the nearest double. The only bounds beyond 2^53 are ±2^63.
    const double value = parameter_number(type, p, i);
    if (value >= specs[i].hard_min && value <= specs[i].hard_max) continue;  // false for NaN
    return core::invalid_argument(fmt::format("{}: {} = {} is not allowed: it must be {} ({})",
                                              type.name(), specs[i].name,
                                              value_text(specs[i], p, i), allowed_text(specs[i]),
                                              predicted_cost_text(type.log2_cost(p))));
  }
  const double cost = type.log2_cost(p);
  if (cost <= max_log2_cost) return {};
  std::string values;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    if (specs[i].type != ParameterType::kInteger || specs[i].source == ParameterSource::kPlaced)
      continue;
    values += fmt::format("{}{} = {}", values.empty() ? "" : ", ", specs[i].name, p.integer(i));
  }
  return core::fail(core::ErrorCode::kOverBudget,
                    fmt::format("{}: {} together are too large ({}; allowed: 2^{:g})", type.name(),
                                values, predicted_cost_text(cost), max_log2_cost));
}

}  // namespace psygen::models
