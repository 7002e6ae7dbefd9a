#include "engine/telemetry/summary_fields.hpp"

#include <nlohmann/json.hpp>

namespace psygen::telemetry {
namespace {

using Json = nlohmann::ordered_json;

void flatten(const Json& json, const std::string& name, std::vector<SummaryField>& fields) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items())
      flatten(value, name.empty() ? key : name + "." + key, fields);
    return;
  }
  if (json.is_array()) return;
  SummaryField field{name, {}, {}};
  if (json.is_number()) field.value = json.get<double>();
  if (json.is_string()) field.value = json.get<std::string>();
  if (json.is_boolean()) field.value = std::string(json.get<bool>() ? "true" : "false");
  fields.push_back(std::move(field));
}

}  // namespace

std::vector<SummaryField> summary_fields(const Summary& summary) {
  Json json = Json::parse(to_json(summary));
  const Json reasons = json["reasons"];
  json.erase("reasons");
  std::vector<SummaryField> fields;
  flatten(json, "", fields);
  for (SummaryField& field : fields)
    if (reasons.contains(field.name)) field.reason = reasons[field.name].get<std::string>();
  return fields;
}

}  // namespace psygen::telemetry
