#include <fmt/format.h>

#include "tests/engine/captures/fixture.hpp"

namespace psygen::captures {
namespace {

using testing::HasSubstr;

std::string cap_frame_x(std::string_view runs) {
  return fmt::format(R"({{"Info": {{"GameName": "Hills"}}, "Runs": [{}]}})", runs);
}

TEST(CapFrameXJson, ReadsTheFramesOfEveryRun) {
  const Capture capture = read_text(cap_frame_x(
      R"({"CaptureData": {"Dropped": [false, true, false], "MsBetweenPresents": [8, 9, "NaN"]}},
         {"CaptureData": {"MsBetweenPresents": null}},
         {"CaptureData": {"MsBetweenPresents": [7.5], "Dropped": null}, "SensorData": null})"));
  EXPECT_THAT(capture, times_are({8, 7.5}));
  EXPECT_EQ(capture.tool, "CapFrameX");
  EXPECT_THAT(capture, notes_with("not displayed: 1"));
  EXPECT_THAT(capture, notes_with("rows without a time: 1"));
}

TEST(CapFrameXJson, RefusesArraysOfOtherLengthsAndNegativeTimes) {
  EXPECT_THAT(error_of(cap_frame_x(
                  R"({"CaptureData": {"MsBetweenPresents": [8, 9], "Dropped": [false]}})")),
              HasSubstr("Dropped has 1 values, but MsBetweenPresents has 2"));
  EXPECT_THAT(error_of(cap_frame_x(R"({"CaptureData": {"MsBetweenPresents": [-8]}})")),
              HasSubstr("'-8' is not a time"));
}

std::string group(std::string_view name, int unit, std::string_view samples) {
  return fmt::format(R"({{"Name": "{}", "Unit": {}, "Samples": [{}]}})", name, unit, samples);
}

TEST(UnityTests, ReadTheLargestGroupOfFrames) {
  const Capture capture = read_text(fmt::format(
      R"({{"Results": [{{"SampleGroups": [{}, {}], "Name": "Walk"}},
          {{"Name": "Load", "SampleGroups": [{}]}}]}})",
      group("Time", 1, "15000, 16500, 17000"), group("Memory", 6, "1, 2, 3, 4, 5"),
      group("Time", 3, "2.5")));
  EXPECT_THAT(capture, times_are({15, 16.5, 17}));
  EXPECT_EQ(capture.column, "Time of Walk");
  EXPECT_THAT(capture, notes_with("samples of Time of Load: 1"));
}

TEST(UnityTests, ReadLinesOfNUnitAndNamesOfOldVersions) {
  EXPECT_THAT(
      read_text("<test-run>\n<output><![CDATA[##performancetestresult2:{\"Name\": \"Walk\", "
                "\"SampleGroups\": [" +
                group("Time", 0, "15000000") + "]}\n]]></output>\n"),
      times_are({15}));
  EXPECT_THAT(read_text(R"({"Results": [{"TestName": "Walk", "SampleGroups": [{"Samples": [14],
                            "Definition": {"Name": "Time", "SampleUnit": 2}}]}]})"),
              times_are({14}));
}

TEST(UnityTests, WithoutFramesAreRefused) {
  EXPECT_THAT(
      error_of(fmt::format(R"({{"Results": [{{"SampleGroups": [{}]}}]}})", group("Time", 6, "5"))),
      HasSubstr("no test measured frames"));
}

std::string draw(int process, double ts) {
  return fmt::format(R"({{"name": "DrawFrame", "ph": "I", "pid": {}, "ts": {}}})", process, ts);
}

TEST(ChromeTrace, SortsTheFramesOfOneProcess) {
  const Capture capture =
      read_text(R"({"displayTimeUnit": "ns", "traceEvents": [)" + draw(1, 31'000) + "," +
                draw(2, 500) + "," + draw(1, 1000) + "," + draw(1, 11'000.5) +
                R"(,{"name": "DroppedFrame", "ph": "I", "pid": 1, "ts": 12000}]})");
  EXPECT_THAT(capture, times_are({10.0005, 19.9995}));
  EXPECT_THAT(capture, notes_with("events of process 2: 1"));
  EXPECT_THAT(capture, notes_with("not displayed: 1"));
}

TEST(ChromeTrace, MayLackItsEnd) {
  const Capture capture = read_text(
      "[\n{\"name\": \"Frame\", \"ph\": \"X\", \"ts\": 9, \"dur\": 12500, \"pid\": 1},\n"
      "{\"name\": \"Update\", \"ph\": \"X\", \"ts\": 9, \"dur\": 1},\n"
      "{\"name\": \"Frame\", \"ph\": \"X\", \"ts\": 1, \"dur\": 11000, \"pid\": 1},\n{\"name\": "
      "\"F");
  EXPECT_THAT(capture, times_are({11, 12.5}));
  EXPECT_EQ(capture.meaning, Meaning::kGameThread);
  EXPECT_THAT(capture, notes_with("the cut last row"));
  EXPECT_THAT(error_of(R"({"traceEvents": [{"name": "Load", "ph": "X", "ts": 1, "dur": 2}]})"),
              HasSubstr("the trace has no frames"));
}

TEST(Json, OfOtherKindsIsRefused) {
  EXPECT_THAT(error_of(R"({"engine": {}, "benchmarks": [{"results": {"time": 3}}]})"),
              HasSubstr("means of whole benchmarks, no frames"));
  EXPECT_THAT(error_of(R"({"a": 1})"), HasSubstr("no capture that psygen reads"));
  EXPECT_THAT(error_of("{\"Runs\":\n[1,}"), HasSubstr("log.csv:2: it is not JSON"));
  EXPECT_THAT(error_of(R"({"Runs": [{"CaptureData": {"MsBetweenPresents": [1)"),
              HasSubstr("truncated"));
}

TEST(Json, NestedDeeplyIsRefused) {
  std::string deep;
  for (int i = 0; i < 100'000; ++i)
    deep += "{\"a\":";
  EXPECT_THAT(error_of(deep), HasSubstr("nested over 64 levels deep"));
}

}  // namespace
}  // namespace psygen::captures
