// Compares a written summary.json with the published docs/summary.schema.json.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "engine/telemetry/summary.hpp"
#include "tests/engine/telemetry/synthetic_flight.hpp"
#include "tests/source_file.hpp"

namespace psygen::telemetry {
namespace {

using nlohmann::json;

bool has_type(const json& value, const std::string& type) {
  if (type == "integer") return value.is_number_integer();
  if (type == "number") return value.is_number();
  return type == (value.is_string()    ? "string"
                  : value.is_boolean() ? "boolean"
                  : value.is_array()   ? "array"
                  : value.is_object()  ? "object"
                                       : "null");
}

// Expects that a value and its schema have the same members. Supports the parts of JSON schemas
// that tools/summary_schema.py writes.
void expect_fits(const json& value, const json& schema, const std::string& name) {
  SCOPED_TRACE(name);
  const json types = schema["type"].is_array() ? schema["type"] : json::array({schema["type"]});
  EXPECT_TRUE(std::ranges::any_of(types, [&](const json& type) { return has_type(value, type); }))
      << value << " is not " << schema["type"];
  if (value.is_number()) {
    EXPECT_GE(value.get<double>(), schema.value("minimum", -1e300));
    EXPECT_LE(value.get<double>(), schema.value("maximum", 1e300));
  }
  if (value.is_string() && schema.contains("pattern")) {
    EXPECT_TRUE(std::regex_match(value.get<std::string>(), std::regex(schema["pattern"])));
  }
  if (value.is_array()) {
    for (const json& item : value)
      expect_fits(item, schema["items"], name + "[]");
  }
  const json fields = schema.value("properties", json::object());
  for (const auto& [key, field] : fields.items())
    EXPECT_TRUE(value.contains(key)) << "summary.json lacks " << key;
  if (!value.is_object() || name == ".reasons") return;  // sentences for any field
  for (const auto& [key, member] : value.items()) {
    const json* found = fields.contains(key) ? &fields[key] : nullptr;
    if (found == nullptr && schema.contains("additionalProperties"))
      found = &schema["additionalProperties"];
    if (found == nullptr) {
      ADD_FAILURE() << "docs/summary.md lacks " << name.substr(1) << "." << key;
      continue;
    }
    expect_fits(member, *found, name + "." + key);
  }
}

json published_schema() {
  std::ifstream file(source_file("docs/summary.schema.json"));
  return json::parse(file);
}

TEST(SummarySchema, FitsACompleteFlight) {
  const Summary summary = summarise(synthetic_flight(), synthetic_facts(), 1.0);
  expect_fits(json::parse(to_json(summary)), published_schema(), "");
}

TEST(SummarySchema, FitsAFlightWithFiguresMarksAndSections) {
  FrameLog log({"hunt"}, 10, {{.name = "ai.paths", .unit = "paths"}});
  log.add({}, std::array{1.0F}, std::array{3.0});
  log.add_mark("boss");
  log.add({});
  RunFacts facts = synthetic_facts();
  facts.sections = {{"fight", "boss", "end"}, {"never", "ghost", "end"}};
  expect_fits(json::parse(to_json(summarise(log, facts, 0))), published_schema(), "");
}

TEST(SummarySchema, FitsAFlightWithoutAnyValue) {
  json schema = published_schema();
  schema["properties"]["run"]["properties"]["width"]["minimum"] = 0;  // no image
  schema["properties"]["run"]["properties"]["height"]["minimum"] = 0;
  schema["properties"]["run"]["properties"]["error_pixels"]["minimum"] = 0;
  expect_fits(json::parse(to_json(Summary{})), schema, "");
}

TEST(SummarySchema, HasTheVersionOfTheFormat) {
  EXPECT_EQ(published_schema()["title"], kSummarySchema);
}

}  // namespace
}  // namespace psygen::telemetry
