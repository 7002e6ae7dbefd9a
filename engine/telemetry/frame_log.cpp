#include "engine/telemetry/frame_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <new>

#include "engine/core/assert.hpp"
#include "engine/core/headroom.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/core/replace_file.hpp"

namespace psygen::telemetry {
namespace {

constexpr std::string_view kColumnsBeforeSystems =
    "frame,time_s,frame_ms,main_cpu_ms,wait_ms,gpu_ms";
constexpr std::string_view kColumnsAfterSystems =
    "error_pixels,triangles,draws,nodes_in_view,holes,coarse_nodes,missing_pixels_percent,cache_"
    "bytes,cache_"
    "hits,"
    "cache_misses,cache_evictions,cache_regenerations,requests_queued,requests_completed,"
    "models_synthesised,triangles_synthesised,bytes_synthesised,synthesis_seconds";

std::string row(const FrameRecord& r, std::size_t system_count) {
  std::string text;
  const auto to = std::back_inserter(text);
  fmt::format_to(to, "{},{:.6f},{:.4f},{:.4f},{:.4f},{:.4f}", r.index, r.time_s, r.frame_ms,
                 r.main_cpu_ms, r.wait_ms, r.gpu_ms);
  for (std::size_t i = 0; i < system_count; ++i)
    fmt::format_to(to, ",{:.4f}", r.system_ms[i]);
  fmt::format_to(to, ",{:.3f},{},{},{},{},{},{:.4f},{},{},{},{},{},{},{},{},{},{},{:.6f}\n",
                 r.error_pixels, r.triangles, r.draws, r.nodes_in_view, r.holes, r.coarse_nodes,
                 r.missing_pixels_percent, r.cache_bytes, r.cache_hits, r.cache_misses,
                 r.cache_evictions, r.cache_regenerations, r.requests_queued, r.requests_completed,
                 r.models_synthesised, r.triangles_synthesised, r.bytes_synthesised,
                 r.synthesis_seconds);
  return text;
}

}  // namespace

FrameLog::FrameLog(std::vector<std::string> systems, std::size_t max_frames)
    : systems_(std::move(systems)), max_frames_(max_frames) {
  PSYGEN_CHECK(systems_.size() <= kMaxSystems, "more systems than a frame record has room for");
  constexpr std::size_t kSmallPart = 4;  // of the memory that is left
  if (core::memory_left(kSmallPart * max_frames_ * sizeof(FrameRecord))) {
    frames_.reserve(max_frames_);
  } else {
    core::note_refused_bytes(0);  // the log does without
  }
}

void FrameLog::add(const FrameRecord& record) {
  if (frames_.size() < max_frames_) {
    try {
      return frames_.push_back(record);
    } catch (const std::bad_alloc&) {
      max_frames_ = frames_.size();
    }
  }
  ++dropped_;
}

void FrameLog::add_cost_error(double time_s, double predicted_s, double actual_s) {
  if (!(actual_s > 0)) return;
  cost_error_percent_.add(time_s, 100.0 * std::abs(predicted_s - actual_s) / actual_s);
}

std::span<const FrameRecord> FrameLog::frames_since(double warmup_s) const {
  const auto first = std::find_if(frames_.begin(), frames_.end(),
                                  [&](const FrameRecord& r) { return r.time_s >= warmup_s; });
  return {first, frames_.end()};
}

core::Result<void> write_frames_csv(const std::filesystem::path& path, const FrameLog& log) {
  core::FileReplacement file(path);
  file.write(kColumnsBeforeSystems);
  for (const std::string& system : log.systems())
    file.write("," + system + "_ms");
  file.write(fmt::format(",{}\n", kColumnsAfterSystems));
  for (const FrameRecord& record : log.frames())
    file.write(row(record, log.systems().size()));
  return file.commit();
}

}  // namespace psygen::telemetry
