#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "engine/telemetry/summary.hpp"
#include "engine/telemetry/summary_fields.hpp"
#include "tests/engine/telemetry/synthetic_flight.hpp"

namespace psygen::telemetry {
namespace {

using nlohmann::json;

json::json_pointer pointer(std::string path) {
  for (char& c : path)
    c = c == '.' ? '/' : c;
  return json::json_pointer("/" + path);
}

TEST(SummaryJson, WritesNamesNumbersAndHashes) {
  const json j = json::parse(to_json(summarise(synthetic_flight(), synthetic_facts(), 1.0)));
  EXPECT_EQ(j["schema"], "psygen.summary/1");
  EXPECT_EQ(j["world"]["blocks"], json::array({512, 512}));
  EXPECT_EQ(j["hash"]["world"], "0123456789abcdef");
  EXPECT_EQ(j["hash"]["path"], "00000000000000ff");
  EXPECT_EQ(j["run"]["path"], "walk");
  EXPECT_EQ(j["run"]["lod"], true);
}

void expect_reasons_for_nulls(const json& j, const json& reasons, const std::string& path) {
  for (const auto& [key, value] : j.items()) {
    const std::string here = path.empty() ? key : path + "." + key;
    if (value.is_object()) expect_reasons_for_nulls(value, reasons, here);
    if (value.is_null()) {
      ASSERT_TRUE(reasons.contains(here)) << here;
      EXPECT_FALSE(reasons[here].get<std::string>().empty()) << here;
    }
  }
}

TEST(SummaryJson, EveryNullHasAReasonAndEveryReasonANull) {
  for (const std::uint64_t frames : {0U, 1U, 50U, 1500U}) {
    json j = json::parse(to_json(summarise(synthetic_flight(frames), synthetic_facts(), 0.0)));
    const json reasons = j["reasons"];
    j.erase("reasons");
    expect_reasons_for_nulls(j, reasons, "");
    for (const auto& [path, reason] : reasons.items())
      EXPECT_TRUE(j.at(pointer(path)).is_null()) << path;
  }
}

TEST(SummaryJson, TooFewFramesAreNullWithTheRequiredNumber) {
  const json j = json::parse(to_json(summarise(synthetic_flight(50), synthetic_facts(), 0.0)));
  EXPECT_TRUE(j["frame_ms"]["p95"].is_number());
  EXPECT_TRUE(j["frame_ms"]["p99"].is_null());
  EXPECT_EQ(j["reasons"]["frame_ms.p99"], "needs at least 100 values, there are 50");
  EXPECT_EQ(j["reasons"]["run.fixed_step"], "the flight follows the clock");
}

TEST(SummaryJson, SurvivesInvalidTextsAndNonFiniteNumbers) {
  RunFacts facts = synthetic_facts();
  facts.world.name = "broken \xFF\xFE \"name\"\n";
  facts.floor_ratio = std::numeric_limits<double>::quiet_NaN();
  facts.prefetch_hit_percent = std::numeric_limits<double>::infinity();
  const json j = json::parse(to_json(summarise(synthetic_flight(10), facts, 0.0)));
  EXPECT_TRUE(j["draw"]["floor_ratio"].is_null());
  EXPECT_TRUE(j["cache"]["prefetch_hit_percent"].is_null());
  EXPECT_EQ(j["reasons"]["draw.floor_ratio"], "the value is not a finite number");
}

TEST(SummaryJson, KeepsAll64BitsOfSeedsAndSizes) {
  RunFacts facts = synthetic_facts();
  facts.world.seed = UINT64_MAX;
  facts.world.bytes = (1ULL << 63) + 1;
  const json j = json::parse(to_json(summarise(synthetic_flight(2), facts, 0.0)));
  EXPECT_EQ(j["world"]["seed"].get<std::uint64_t>(), UINT64_MAX);
  EXPECT_EQ(j["world"]["bytes"].get<std::uint64_t>(), (1ULL << 63) + 1);
}

TEST(SummaryJson, IsReadBackAsFields) {
  const Summary summary = summarise(synthetic_flight(50), synthetic_facts(), 0.0);
  const auto read = summary_fields_in(to_json(summary), "summary.json");
  ASSERT_TRUE(read) << read.error().message;
  const std::vector<SummaryField> fields = summary_fields(summary);
  ASSERT_EQ(read->size(), fields.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    EXPECT_EQ((*read)[i].name, fields[i].name);
    EXPECT_EQ((*read)[i].value, fields[i].value) << fields[i].name;
    EXPECT_EQ((*read)[i].reason, fields[i].reason) << fields[i].name;
  }
  EXPECT_EQ(summary_fields_in("{", "s").error().message, "s: it is not JSON, or is truncated");
  EXPECT_EQ(summary_fields_in("{\"schema\": \"psygen.summary/2\"}", "s").error().message,
            "s: schema: it must be \"psygen.summary/1\"");
}

}  // namespace
}  // namespace psygen::telemetry
