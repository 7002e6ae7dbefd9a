#include "engine/telemetry/trace_log.hpp"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "tests/engine/telemetry/synthetic_flight.hpp"
#include "tests/full_disk.hpp"

namespace psygen::telemetry {
namespace {

using nlohmann::json;

json written(const TraceLog& trace) {
  const TemporaryFolder folder;
  EXPECT_TRUE(trace.write(folder / "trace.json"));
  return json::parse(text_of(folder / "trace.json"));
}

std::vector<json> events_of_kind(const json& trace, const std::string& phase) {
  std::vector<json> events;
  for (const json& event : trace["traceEvents"]) {
    if (event["ph"] == phase) events.push_back(event);
  }
  return events;
}

TEST(TraceLog, WritesSpansWithTrackNameAndTimesInMicroseconds) {
  TraceLog trace;
  const auto main = trace.add_track("main thread");
  const auto modeler = trace.add_track("modeler 1");
  trace.add_span(main, trace.intern("render"), 100.0, 100.016, 7);
  trace.add_span(modeler, trace.intern("tree"), 100.002, 100.0025);
  const json j = written(trace);
  const std::vector<json> spans = events_of_kind(j, "X");
  ASSERT_EQ(spans.size(), 2U);
  EXPECT_EQ(spans[0]["name"], "render");
  EXPECT_NEAR(spans[0]["ts"].get<double>(), 0.0, 1e-9);
  EXPECT_NEAR(spans[0]["dur"].get<double>(), 16'000.0, 1e-2);
  EXPECT_EQ(spans[0]["args"]["id"], 7);
  EXPECT_EQ(spans[1]["tid"], modeler);
  EXPECT_NEAR(spans[1]["ts"].get<double>(), 2'000.0, 1e-2);
  EXPECT_FALSE(spans[1].contains("args"));
  std::map<int, std::string> names;
  for (const json& event : events_of_kind(j, "M")) {
    if (event["name"] == "thread_name") names[event["tid"]] = event["args"]["name"];
  }
  EXPECT_EQ(names.at(main), "main thread");
  EXPECT_EQ(names.at(modeler), "modeler 1");
}

TEST(TraceLog, WritesCountersOverTime) {
  TraceLog trace;
  const auto cache = trace.add_counter("cache bytes");
  trace.add_value(cache, 1.0, 10.0);
  trace.add_value(cache, 2.0, 20.5);
  const std::vector<json> events = events_of_kind(written(trace), "C");
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[1]["name"], "cache bytes");
  EXPECT_EQ(events[1]["args"]["value"], 20.5);
}

TEST(TraceLog, ATrackKeepsItsNewestSpansInOrderIndependentlyOfOthers) {
  TraceLog trace(4);
  const auto main = trace.add_track("main");
  const auto modeler = trace.add_track("modeler");
  const auto name = trace.intern("job");
  trace.add_span(main, name, 0.0, 0.5, 1000);
  for (int i = 0; i < 10; ++i)
    trace.add_span(modeler, name, i, i + 0.5, static_cast<std::uint64_t>(i));
  EXPECT_EQ(trace.dropped_count(), 6U);
  const json j = written(trace);
  std::vector<int> ids;
  for (const json& event : events_of_kind(j, "X"))
    ids.push_back(event["args"]["id"]);
  EXPECT_EQ(ids, (std::vector{1000, 6, 7, 8, 9}));
  EXPECT_EQ(j["otherData"]["spans_dropped"], "6");
}

TEST(TraceLog, TheSameTextIsInternedOnce) {
  TraceLog trace;
  EXPECT_EQ(trace.intern("tree"), trace.intern(std::string("tr") + "ee"));
  EXPECT_NE(trace.intern("tree"), trace.intern("rock"));
}

TEST(TraceLog, NamesWithQuotesAndBrokenTextStayValidJson) {
  TraceLog trace;
  const auto track = trace.add_track("a \"track\"\n\xFF");
  trace.add_span(track, trace.intern("\\ \x01"), 0, 1);
  EXPECT_EQ(events_of_kind(written(trace), "X").size(), 1U);
}

TEST(TraceLog, IgnoresSpansThatEndBeforeTheyStart) {
  TraceLog trace;
  const auto track = trace.add_track("main");
  trace.add_span(track, trace.intern("x"), 2.0, 1.0);
  trace.add_span(track, trace.intern("x"), std::nan(""), 1.0);
  EXPECT_TRUE(events_of_kind(written(trace), "X").empty());
}

TEST(TraceLog, IsCompleteOrAbsentWhenTheDiskFills) {
  TraceLog trace;
  const auto track = trace.add_track("main");
  const auto name = trace.intern("job");
  for (int i = 0; i < 3000; ++i)
    trace.add_span(track, name, i, i + 0.5);
  expect_whole_files([&trace](const auto& folder) { return trace.write(folder / "trace.json"); });
}

}  // namespace
}  // namespace psygen::telemetry
