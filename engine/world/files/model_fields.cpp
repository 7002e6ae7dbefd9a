#include "engine/world/files/model_fields.hpp"

#include <algorithm>

#include "engine/world/placement.hpp"

namespace psygen::world {
namespace {

// The parameter to blame: one outside its hard range or, if all together cost too much, the one on
// the last line.
std::size_t culprit_of(const ModelFields& fields, const models::Parameters& p) {
  const auto specs = fields.type->parameters();
  std::size_t last = 0;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const double value = models::parameter_number(*fields.type, p, i);
    if (!(value >= specs[i].hard_min && value <= specs[i].hard_max)) return i;
    if (fields.lines[i] > fields.lines[last]) last = i;
  }
  return last;
}

std::uint32_t corner_count(const ModelFields& fields) {
  return 1U << std::ranges::count_if(fields.ranges,
                                     [](const ParameterRange& r) { return r.low != r.high; });
}

}  // namespace

ModelFields fields_of(const models::ModelType& type, int line) {
  ModelFields fields{&type, {}, {}, {}};
  for (const models::ParameterSpec& spec : type.parameters()) {
    fields.ranges.push_back({spec.default_value, spec.default_value});
    fields.lines.push_back(line);
    fields.names.emplace_back(spec.name);
  }
  return fields;
}

void read_parameter(TableReader& reader, std::string_view key, std::size_t i, bool is_range,
                    ModelFields& fields) {
  fields.names[i] = reader.field(key);
  const std::optional<NumberRange> range = reader.read_range(key);
  if (!range) return;
  fields.lines[i] = range->line;
  const bool integer = fields.type->parameters()[i].type == models::ParameterType::kInteger;
  if (integer && !range->integers) {
    reader.problem(range->line, key, "it must be an integer, or [lowest, highest] of integers");
  } else if (!is_range && range->low != range->high) {
    reader.problem(range->line, key, "it must be one number, the same for the whole world");
  } else {
    fields.ranges[i] = {range->low, range->high};
  }
}

models::Parameters corner_of(const ModelFields& fields, std::uint32_t corner) {
  models::Parameters p = models::default_parameters(*fields.type);
  std::uint32_t bit = 0;
  for (std::size_t i = 0; i < fields.ranges.size(); ++i) {
    const ParameterRange& range = fields.ranges[i];
    if (fields.type->parameters()[i].source == models::ParameterSource::kPlaced) continue;
    const bool high = range.low != range.high && (corner >> bit++ & 1U) != 0;
    set_parameter(*fields.type, p, i, high ? range.high : range.low);
  }
  return p;
}

bool check_model(const ModelFields& fields, Problems& problems) {
  for (std::uint32_t corner = 0; corner < corner_count(fields); ++corner) {
    const models::Parameters p = corner_of(fields, corner);
    if (const auto valid = models::validate(*fields.type, p); !valid) {
      const std::size_t i = culprit_of(fields, p);
      problems.add(fields.lines[i], fields.names[i], valid.error().message, valid.error().code);
      return false;
    }
  }
  return true;
}

double log2_cost(const ModelFields& fields) {
  double cost = 0;
  for (std::uint32_t corner = 0; corner < corner_count(fields); ++corner)
    cost = std::max(cost, fields.type->log2_cost(corner_of(fields, corner)));
  return cost;
}

}  // namespace psygen::world
