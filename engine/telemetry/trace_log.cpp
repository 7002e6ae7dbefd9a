#include "engine/telemetry/trace_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/core/assert.hpp"
#include "engine/core/replace_file.hpp"

namespace psygen::telemetry {
namespace {

std::string quoted(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

TraceLog::TraceLog(std::size_t max_spans_per_track) : max_spans_(max_spans_per_track) {
  PSYGEN_CHECK(max_spans_ > 0, "the capacity must be at least one span");
}

TraceLog::Track TraceLog::add_ring(std::string_view name, bool is_counter) {
  PSYGEN_CHECK(rings_.size() < UINT16_MAX, "too many tracks in a trace");
  rings_.push_back({std::string(name), is_counter, {}, 0});
  return static_cast<Track>(rings_.size() - 1);
}

TraceLog::Track TraceLog::add_track(std::string_view name) {
  return add_ring(name, false);
}

TraceLog::Track TraceLog::add_counter(std::string_view name) {
  return add_ring(name, true);
}

TraceLog::Name TraceLog::intern(std::string_view name) {
  const auto [entry, is_new] =
      ids_.try_emplace(std::string(name), static_cast<Name>(names_.size()));
  if (is_new) {
    PSYGEN_CHECK(names_.size() < UINT16_MAX, "too many names in a trace");
    names_.emplace_back(name);
  }
  return entry->second;
}

void TraceLog::add(Ring& ring, const Span& span) {
  if (ring.spans.size() < max_spans_) {
    ring.spans.push_back(span);
  } else {
    ring.spans[ring.added % max_spans_] = span;
  }
  ++ring.added;
}

void TraceLog::add_span(Track track, Name name, double start_s, double end_s,
                        std::uint64_t argument) {
  PSYGEN_ASSERT(track < rings_.size() && !rings_[track].is_counter, "unknown track of a span");
  PSYGEN_ASSERT(name < names_.size(), "the name of the span was not interned");
  if (!(end_s >= start_s)) return;
  add(rings_[track], {start_s, end_s - start_s, argument, name});
}

void TraceLog::add_value(Track counter, double time_s, double value) {
  PSYGEN_ASSERT(counter < rings_.size() && rings_[counter].is_counter,
                "unknown counter of a value");
  if (!std::isfinite(time_s) || !std::isfinite(value)) return;
  add(rings_[counter], {time_s, value, kNoArgument, 0});
}

std::uint64_t TraceLog::dropped_count() const {
  std::uint64_t count = 0;
  for (const Ring& ring : rings_)
    count += ring.added - ring.spans.size();
  return count;
}

double TraceLog::earliest_s() const {
  double earliest = std::numeric_limits<double>::infinity();
  for (const Ring& ring : rings_) {
    for (const Span& span : ring.spans)
      earliest = std::min(earliest, span.start_s);
  }
  return std::isfinite(earliest) ? earliest : 0.0;
}

void TraceLog::write_ring(core::FileReplacement& file, std::size_t track, double origin_s,
                          std::span<const std::string> quoted_names) const {
  constexpr double kMicroseconds = 1e6;
  const Ring& ring = rings_[track];
  const std::string title = quoted(ring.name);
  if (!ring.is_counter) {
    file.write(
        fmt::format(",\n{{\"ph\":\"M\",\"pid\":1,\"tid\":{0},\"name\":\"thread_name\","
                    "\"args\":{{\"name\":{1}}}}},\n{{\"ph\":\"M\",\"pid\":1,\"tid\":{0},"
                    "\"name\":\"thread_sort_index\",\"args\":{{\"sort_index\":{0}}}}}",
                    track, title));
  }
  // Oldest first: in a full ring, the oldest span is at the next write position.
  const std::size_t first = ring.added > ring.spans.size() ? ring.added % max_spans_ : 0;
  for (std::size_t k = 0; k < ring.spans.size(); ++k) {
    const Span& span = ring.spans[(first + k) % ring.spans.size()];
    const double time_us = (span.start_s - origin_s) * kMicroseconds;
    if (ring.is_counter) {
      file.write(
          fmt::format(",\n{{\"ph\":\"C\",\"pid\":1,\"ts\":{:.3f},\"name\":{},"
                      "\"args\":{{\"value\":{}}}}}",
                      time_us, title, span.length_or_value));
      continue;
    }
    file.write(
        fmt::format(",\n{{\"ph\":\"X\",\"pid\":1,\"tid\":{},\"ts\":{:.3f},\"dur\":{:.3f},"
                    "\"name\":{}",
                    track, time_us, span.length_or_value * kMicroseconds, quoted_names[span.name]));
    file.write(span.argument == kNoArgument
                   ? std::string("}")
                   : fmt::format(",\"args\":{{\"id\":{}}}}}", span.argument));
  }
}

core::Result<void> TraceLog::write(const std::filesystem::path& path) const {
  std::vector<std::string> names;
  for (const std::string& name : names_)
    names.push_back(quoted(name));
  const double origin_s = earliest_s();
  core::FileReplacement file(path);
  file.write(
      fmt::format("{{\"displayTimeUnit\":\"ms\",\"otherData\":{{\"spans_dropped\":\"{}\"}},\n"
                  "\"traceEvents\":[\n",
                  dropped_count()));
  file.write(R"({"ph":"M","pid":1,"name":"process_name","args":{"name":"psygen"}})");
  for (std::size_t track = 0; track < rings_.size(); ++track)
    write_ring(file, track, origin_s, names);
  file.write("\n]}\n");
  return file.commit();
}

}  // namespace psygen::telemetry
