// Captures as JSON: CapFrameX, Unity Performance Testing, and traces of Chrome. Reads events of the
// parser and keeps only times, so memory is bounded by the frames.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/captures/readers.hpp"

namespace psygen::captures {
namespace {

using Json = nlohmann::json;
// Keys from the root to a value; "*" for an element of an array.
using Path = std::vector<std::string>;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// A number, text or flag in a file. Texts such as "NaN" are numbers that are missing.
struct Scalar {
  std::optional<double> number;
  std::string_view text;
  bool flag = false;

  std::string shown() const { return number ? fmt::format("{}", *number) : std::string(text); }
};

bool is_time_or_missing(const Scalar& value) {
  return value.number ? *value.number >= 0 && *value.number < kMaxMs
                      : number_in(value.text, ',').missing;
}

// CapFrameX: arrays of each run, one value a frame.
struct CapFrameX {
  std::vector<double> times;  // of the run that is being read; NaN: missing
  std::vector<bool> dropped;
  std::size_t runs = 0;
  Collected result;

  // Both return a sentence about damaged content, or nothing.
  std::string value(const Path& path, const Scalar& value) {
    if (path.size() != 5 || path[0] != "Runs" || path[2] != "CaptureData") return {};
    if (same_name(path[3], "Dropped")) dropped.push_back(value.flag || value.number == 1.0);
    if (!same_name(path[3], "MsBetweenPresents")) return {};
    if (!is_time_or_missing(value))
      return fmt::format("MsBetweenPresents: '{}' is not a time", value.shown());
    times.push_back(value.number.value_or(0));
    return {};
  }
  std::string close(const Path& path) {
    if (path.size() != 3 || path[0] != "Runs" || path[2] != "CaptureData") return {};
    ++runs;
    if (!dropped.empty() && dropped.size() != times.size())
      return fmt::format("Dropped has {} values, but MsBetweenPresents has {}", dropped.size(),
                         times.size());
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (!dropped.empty() && dropped[i]) {
        ++result.not_drawn;
      } else {
        result.add(times[i]);
      }
    }
    times.clear();
    dropped.clear();
    return {};
  }
  Reading finish() {
    result.capture.tool = "CapFrameX";
    result.capture.column = "MsBetweenPresents";
    if (runs > 1) result.capture.notes.push_back(fmt::format("the file holds {} runs", runs));
    return std::move(result);
  }
};

// Unity Performance Testing: groups of samples of each test. Frames are in the groups that
// Measure.Frames() writes.
struct UnityTests {
  struct Group {
    std::string test, name;
    int unit = -1;
    std::vector<double> samples;
  };
  Group open;
  std::vector<Group> of_test, groups;  // groups of the test that is being read; of all tests
  std::string test;
  std::size_t others = 0;
  bool seen = false;

  // Length of the path to a group's members: tests of a whole file stand in Results.
  static std::size_t depth(const Path& path) { return path[0] == "Results" ? 4 : 2; }

  std::string value(const Path& path, const Scalar& value) {
    const std::size_t at = depth(path);
    if (path.size() == at - 1 && (path[at - 2] == "Name" || path[at - 2] == "TestName"))
      test = value.text;
    if (path.size() < at + 1 || path[at - 2] != "SampleGroups") return {};
    const std::string& key = path.back();
    seen = true;
    if (key == "Name") open.name = value.text;
    if (key == "Unit" || key == "SampleUnit")
      open.unit = value.number && *value.number >= 0 && *value.number <= 7
                      ? static_cast<int>(*value.number)
                      : -1;
    if (path.size() != at + 2 || path[at] != "Samples") return {};
    if (!value.number) return number_in(value.text, ',').missing ? "" : "a sample is no number";
    open.samples.push_back(*value.number);
    return {};
  }
  std::string close(const Path& path) {
    if (path.empty()) {  // the only test of a document
      end_test();
      return {};
    }
    const std::size_t at = depth(path);
    if (path.size() == at && path[at - 2] == "SampleGroups") {
      of_test.push_back(std::move(open));
      open = {};
    }
    if (at == 4 && path.size() == 2) end_test();
    return {};
  }
  void end_test() {
    constexpr std::size_t kMaxGroups = 100'000;
    for (Group& group : of_test) {
      const bool frames = same_name(group.name, "Time") || same_name(group.name, "FrameTime") ||
                          same_name(group.name, "Frame Time");
      if (!frames || group.unit < 0 || group.unit > 3 || groups.size() == kMaxGroups) {
        ++others;
        continue;
      }
      group.test = test;
      groups.push_back(std::move(group));
    }
    of_test.clear();
    test.clear();
  }
  Reading finish(const Source& source) {
    constexpr std::array<double, 4> kUnitMs = {1e-6, 1e-3, 1, 1000};
    const auto best = std::ranges::max_element(
        groups, {}, [](const Group& group) { return group.samples.size(); });
    if (best == groups.end())
      return refused(source,
                     "no test measured frames: no group of samples has the name Time and a "
                     "unit of time");
    Collected result;
    for (const double sample : best->samples) {
      const double ms = sample * kUnitMs[static_cast<std::size_t>(best->unit)];
      if (!(ms >= 0 && ms < kMaxMs))
        return refused(source, fmt::format("{}, {}: the sample {} is no time", best->test,
                                           best->name, sample));
      result.add(ms);
    }
    result.capture.tool = "Unity Performance Testing";
    result.capture.column = fmt::format("{} of {}", best->name, best->test);
    result.capture.meaning = Meaning::kGameThread;
    for (const Group& group : groups)
      if (&group != &*best && result.capture.notes.size() < 8)
        result.capture.notes.push_back(fmt::format("left out: samples of {} of {}: {}", group.name,
                                                   group.test, group.samples.size()));
    if (others > 0)
      result.capture.notes.push_back(
          fmt::format("left out: groups that are no frames: {}", others));
    return result;
  }
};

// Traces: the events of each process are sorted by time. A frame is the time from one DrawFrame to
// the next, or the duration of an event whose name says so.
struct Trace {
  struct Event {
    double ts, duration;
  };
  struct Stream {
    std::vector<Event> events;
    std::size_t dropped = 0;
  };
  struct Open {
    std::string name, phase, process, thread, layer;
    double ts = kNone, duration = kNone;

    std::string drawing() const {
      return layer.empty() ? fmt::format("process {}", process)
                           : fmt::format("process {}, layer tree {}", process, layer);
    }
  };
  Open open;
  std::map<std::string, Stream> draws, frames;
  bool seen = false;

  // Length of the path to an event; 0 if the path is not in one.
  static std::size_t depth(const Path& path) {
    if (!path.empty() && path[0] == "*") return 1;
    return path.size() > 1 && path[0] == "traceEvents" && path[1] == "*" ? 2 : 0;
  }
  static bool names_a_frame(std::string_view name) {
    if (name.size() < 5 || !same_name(name.substr(0, 5), "Frame"))
      return same_name(name, "GameFrame") || same_name(name, "Game Frame") ||
             same_name(name, "MainFrame") || same_name(name, "Main Frame");
    const std::string_view rest = name.substr(5);
    return same_name(rest, "Time") || same_name(rest, " Time") ||
           rest.find_first_not_of(" #0123456789") == std::string_view::npos;
  }

  std::string value(const Path& path, const Scalar& value) {
    const std::size_t at = depth(path);
    if (at == 0) return {};
    if (path.back() == "layerTreeId") open.layer = value.shown();
    if (path.size() != at + 1) return {};
    if (path.back() == "name") open.name = value.text;
    if (path.back() == "ph") open.phase = value.text;
    if (path.back() == "pid") open.process = value.shown();
    if (path.back() == "tid") open.thread = value.shown();
    if (path.back() == "ts") open.ts = value.number.value_or(kNone);
    if (path.back() == "dur") open.duration = value.number.value_or(kNone);
    return {};
  }
  std::string close(const Path& path) {
    constexpr std::size_t kMaxStreams = 4096;
    const std::size_t at = depth(path);
    if (at == 0 || path.size() != at) return {};
    Open event;
    std::swap(event, open);
    seen = seen || !event.phase.empty();
    const bool timed = event.ts > -1e18 && event.ts < 1e18;
    if (!timed) return {};
    if (event.name == "DrawFrame") draws[event.drawing()].events.push_back({event.ts, 0});
    if (event.name == "DroppedFrame") ++draws[event.drawing()].dropped;
    if (event.phase == "X" && names_a_frame(event.name)) {
      if (!(event.duration >= 0 && event.duration < 1000 * kMaxMs))
        return fmt::format("dur of {}: it is not a time", event.name);
      frames[fmt::format("process {}, thread {}", event.process, event.thread)].events.push_back(
          {event.ts, event.duration});
    }
    return draws.size() + frames.size() > kMaxStreams
               ? fmt::format("over {} processes draw frames", kMaxStreams)
               : "";
  }
  Reading finish(const Source& source) {
    constexpr double kMicrosecondMs = 1e-3;
    const auto most = [](std::map<std::string, Stream>& streams) {
      return std::ranges::max_element(streams, {},
                                      [](const auto& entry) { return entry.second.events.size(); });
    };
    const auto draw = most(draws);
    const bool draws_frames = draw != draws.end() && draw->second.events.size() > 1;
    std::map<std::string, Stream>& streams = draws_frames ? draws : frames;
    const auto best = draws_frames ? draw : most(frames);
    if (best == streams.end())
      return refused(source,
                     "the trace has no frames: no events DrawFrame, and no complete events "
                     "(ph X) with the name Frame");
    Collected result;
    std::vector<Event>& events = best->second.events;
    std::ranges::stable_sort(events, {}, &Event::ts);
    for (std::size_t i = draws_frames ? 1 : 0; i < events.size(); ++i) {
      const double us = draws_frames ? events[i].ts - events[i - 1].ts : events[i].duration;
      const double ms = us * kMicrosecondMs;
      result.add(ms < kMaxMs ? ms : 0);
    }
    result.not_drawn = best->second.dropped;
    result.capture.tool = "Chrome trace";
    result.capture.column = draws_frames ? "DrawFrame" : "dur of Frame";
    result.capture.meaning = draws_frames ? Meaning::kPresents : Meaning::kGameThread;
    std::size_t others = 0;
    for (const auto& [name, stream] : streams)
      if (&stream != &best->second && ++others <= 8)
        result.capture.notes.push_back(
            fmt::format("left out: events of {}: {}", name, stream.events.size()));
    return result;
  }
};

// Receives the parser's events, keeps the path, and passes values on.
class Walk final : public nlohmann::json_sax<Json> {
 public:
  bool null() override { return value({.number = {}, .text = "null"}); }
  bool boolean(bool flag) override {
    return value({.number = {}, .text = flag ? "true" : "false", .flag = flag});
  }
  bool number_integer(number_integer_t v) override { return number(static_cast<double>(v)); }
  bool number_unsigned(number_unsigned_t v) override { return number(static_cast<double>(v)); }
  bool number_float(number_float_t v, const string_t& /*text*/) override { return number(v); }
  bool string(string_t& text) override { return value({.number = {}, .text = text}); }
  bool binary(binary_t& /*bytes*/) override { return true; }
  bool start_object(std::size_t /*size*/) override { return enter(""); }
  bool key(string_t& name) override { return path_.back() = name, true; }
  bool end_object() override { return leave(); }
  bool start_array(std::size_t /*size*/) override { return enter("*"); }
  bool end_array() override { return leave(); }
  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const nlohmann::detail::exception& /*error*/) override {
    broken_at = position;
    return false;
  }

  CapFrameX cap_frame_x;
  UnityTests unity;
  Trace trace;
  bool has_benchmarks = false;           // of Godot
  std::optional<std::size_t> broken_at;  // the byte where it is not JSON
  std::string sentence;                  // about damaged content

 private:
  bool keep(std::string&& why) {
    if (sentence.empty()) sentence = std::move(why);
    return sentence.empty();
  }
  bool number(double v) { return value({.number = v, .text = {}}); }
  bool value(const Scalar& scalar) {
    if (path_.empty()) return true;
    has_benchmarks = has_benchmarks || path_[0] == "benchmarks";
    return keep(cap_frame_x.value(path_, scalar)) && keep(unity.value(path_, scalar)) &&
           keep(trace.value(path_, scalar));
  }
  bool enter(const char* name) {
    constexpr std::size_t kMaxDepth = 64;
    if (path_.size() == kMaxDepth)
      return keep(fmt::format("the JSON is nested over {} levels deep", kMaxDepth));
    path_.emplace_back(name);
    return true;
  }
  bool leave() {
    path_.pop_back();
    return keep(cap_frame_x.close(path_)) && keep(unity.close(path_)) && keep(trace.close(path_));
  }

  Path path_;
};

std::size_t line_at(std::string_view text, std::size_t position) {
  return 1 + static_cast<std::size_t>(
                 std::ranges::count(text.substr(0, std::min(position, text.size())), '\n'));
}

}  // namespace

Reading read_json(const Source& source) {
  Walk walk;
  Json::sax_parse(source.text.begin(), source.text.end(), &walk);
  const bool cut = walk.broken_at && *walk.broken_at > source.text.size();
  const bool is_trace = walk.trace.seen;
  if (!walk.sentence.empty()) return damaged(source, 1, walk.sentence);
  if (walk.broken_at && !(cut && is_trace))
    return damaged(source, line_at(source.text, *walk.broken_at),
                   cut ? "the JSON is truncated" : "it is not JSON");
  Reading result = walk.cap_frame_x.runs > 0 ? walk.cap_frame_x.finish()
                   : walk.unity.seen         ? walk.unity.finish(source)
                   : is_trace                ? walk.trace.finish(source)
                   : walk.has_benchmarks
                       ? refused(source,
                                 "the results of Godot's benchmarks are means of whole "
                                 "benchmarks, no frames")
                       : refused(source,
                                 "the JSON is no capture that psygen reads: CapFrameX, Unity "
                                 "Performance Testing, Chrome trace");
  if (result) result->cut = cut;
  return result;
}

Reading read_unity_lines(const Source& source) {
  Walk walk;
  std::string_view rest = source.text;
  for (Line line; next_line(rest, line);) {
    const std::size_t mark = line.text.find(kUnityMark);
    if (mark == std::string_view::npos) continue;
    std::string_view json = line.text.substr(mark + kUnityMark.size());
    json = json.substr(0, json.rfind('}') + 1);
    Json::sax_parse(json.begin(), json.end(), &walk);
    if (walk.broken_at || !walk.sentence.empty())
      return damaged(source, line.number,
                     walk.sentence.empty() ? "the result is not JSON" : walk.sentence);
  }
  return walk.unity.finish(source);
}

}  // namespace psygen::captures
