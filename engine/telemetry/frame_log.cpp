#include "engine/telemetry/frame_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <new>

#include "engine/core/assert.hpp"
#include "engine/core/hash.hpp"
#include "engine/core/headroom.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/core/replace_file.hpp"

namespace psygen::telemetry {
namespace {

constexpr std::string_view kColumnsBeforeSystems =
    "frame,time_s,frame_ms,main_cpu_ms,wait_ms,device_wait_ms,acquire_ms,present_ms,record_ms,"
    "gpu_ms,gpu_shadows_ms,apart";
constexpr std::string_view kColumnsAfterSystems =
    "error_pixels,memory_factor,resolution,triangles,draws,nodes_in_view,holes,coarse_nodes,"
    "missing_pixels_percent,too_coarse_percent,cache_bytes,cache_hits,cache_misses,"
    "cache_evictions,cache_regenerations,requests_queued,requests_refused,requests_completed,"
    "models_failed,models_synthesised,triangles_synthesised,bytes_synthesised,synthesis_seconds,"
    "between_presents_ms,animation_error_ms,device_bytes";
// The GPU time of a frame arrives at most this many frames later.
constexpr std::size_t kLatestFrames = 16;

// The columns of own figures.
constexpr std::string_view kOwnPrefix = "figures.";

// Appends the values of row `rows`; NaN if their number is not `count`.
template <class T>
void add_values(std::span<const T> row, std::size_t rows, std::size_t count,
                std::vector<T>& values) {
  values.resize((rows + 1) * count, std::numeric_limits<T>::quiet_NaN());
  if (row.size() == count) std::ranges::copy(row, values.end() - std::ssize(row));
}

std::string cell(const std::optional<double>& ms) {
  return ms && !std::isnan(*ms) ? fmt::format("{:.4f}", *ms) : std::string();
}

std::string row(const FrameRecord& r, std::span<const float> system_ms) {
  std::string text;
  const auto to = std::back_inserter(text);
  fmt::format_to(to, "{},{:.6f},{:.4f},{},{},{},{},{},{},{},{},{}", r.index, r.time_s, r.frame_ms,
                 cell(r.main_cpu_ms), cell(r.wait_ms()), cell(r.device_wait_ms), cell(r.acquire_ms),
                 cell(r.present_ms), cell(r.record_ms), cell(r.gpu_ms), cell(r.gpu_shadows_ms),
                 name_of(r.apart));
  for (const float ms : system_ms)
    std::isnan(ms) ? fmt::format_to(to, ",") : fmt::format_to(to, ",{:.4f}", ms);
  fmt::format_to(to,
                 ",{:.3f},{:.3f},{:.3f},{},{},{},{},{},{:.4f},{:.4f},{},{},{},{},{},{},{},{},{},{},"
                 "{},{},{:.6f}",
                 r.error_pixels, r.memory_factor, r.resolution, r.triangles, r.draws,
                 r.nodes_in_view, r.holes, r.coarse_nodes, r.missing_pixels_percent,
                 r.too_coarse_percent, r.cache_bytes, r.cache_hits, r.cache_misses,
                 r.cache_evictions, r.cache_regenerations, r.requests_queued, r.requests_refused,
                 r.requests_completed, r.models_failed, r.models_synthesised,
                 r.triangles_synthesised, r.bytes_synthesised, r.synthesis_seconds);
  fmt::format_to(to, ",{},{},{}", cell(r.between_presents_ms), cell(r.animation_error_ms),
                 r.device_bytes ? std::to_string(*r.device_bytes) : "");
  return text;
}

// The cells of passes and of own figures, and that of the marks, beginning with mark number `mark`.
std::string other_cells(const FrameLog& log, std::size_t row, std::size_t& mark) {
  std::string text;
  for (const float ms : log.pass_ms(row))
    std::isnan(ms) ? text += ',' : text += fmt::format(",{:.4f}", ms);
  for (const double value : log.own(row))
    std::isnan(value) ? text += ',' : text += fmt::format(",{:.10g}", value);
  text += ',';
  for (bool first = true; mark < log.marks().size() && log.marks()[mark].row == row; ++mark) {
    text += (first ? "" : " ") + log.marks()[mark].name;
    first = false;
  }
  return text + "\n";
}

}  // namespace

SampleSet::SampleSet(std::size_t capacity) : capacity_(capacity) {
  PSYGEN_CHECK(capacity > 0, "the capacity must be at least one sample");
}

void SampleSet::add(double time_s, double value) {
  if (!std::isfinite(time_s) || !std::isfinite(value)) return;
  if (added_ == 0 || value > largest_.value) largest_ = {time_s, value};
  if (samples_.size() < capacity_) {
    samples_.push_back({time_s, value});
  } else {
    const std::uint64_t slot = core::mix64(added_) % (added_ + 1);
    if (slot < capacity_) samples_[slot] = {time_s, value};
  }
  ++added_;
}

std::vector<double> SampleSet::values_since(double from_s, double until_s) const {
  const auto counts = [&](const Sample& sample) {
    return sample.time_s >= from_s && sample.time_s < until_s;
  };
  std::vector<double> values;
  for (const Sample& sample : samples_) {
    if (counts(sample)) values.push_back(sample.value);
  }
  const bool largest_is_missing =
      added_ > samples_.size() && counts(largest_) &&
      std::find(values.begin(), values.end(), largest_.value) == values.end();
  if (largest_is_missing) values.push_back(largest_.value);
  return values;
}

std::string_view name_of(Apart apart) {
  constexpr std::array<std::string_view, kApartKinds> kNames = {
      "", "picture", "after_idle", "resized", "not_drawn", "gap"};
  return kNames[static_cast<std::size_t>(apart)];
}

std::string picture_name(std::uint64_t index) {
  return fmt::format("frame_{:05}.png", index);
}

FrameLog::FrameLog(std::vector<std::string> systems, std::size_t max_frames,
                   std::vector<FigureInfo> figures, std::vector<std::string> passes)
    : systems_(std::move(systems)),
      max_frames_(max_frames),
      figures_(std::move(figures)),
      passes_(std::move(passes)) {
  constexpr std::size_t kSmallPart = 4;  // fraction of the available memory
  const std::size_t row_bytes = sizeof(FrameRecord) +
                                (systems_.size() + passes_.size()) * sizeof(float) +
                                figures_.size() * sizeof(double);
  if (core::memory_left(kSmallPart * max_frames_ * row_bytes)) {
    frames_.reserve(max_frames_);
    system_ms_.reserve(max_frames_ * systems_.size());
    own_.reserve(max_frames_ * figures_.size());
    pass_ms_.reserve(max_frames_ * passes_.size());
  } else {
    core::record_failed_allocation(0);  // the log continues with fewer rows
  }
}

void FrameLog::add(const FrameRecord& record, std::span<const float> system_ms,
                   std::span<const double> own) {
  if (frames_.size() < max_frames_) {
    try {
      add_values(system_ms, frames_.size(), systems_.size(), system_ms_);
      add_values(own, frames_.size(), figures_.size(), own_);
      add_values(std::span<const float>{}, frames_.size(), passes_.size(), pass_ms_);
      frames_.push_back(record);
      return;
    } catch (const std::bad_alloc&) {
      max_frames_ = frames_.size();
    }
  }
  ++dropped_;
}

void FrameLog::add_mark(std::string name) {
  if (!frames_.empty() && dropped_ == 0) marks_.push_back({frames_.size() - 1, std::move(name)});
}

void FrameLog::set_gpu_ms(std::uint64_t device_frame, double ms, double shadows_ms,
                          std::span<const double> pass_ms) {
  const std::size_t looked_at = std::min(frames_.size(), kLatestFrames);
  const auto found =
      std::find_if(frames_.rbegin(), frames_.rbegin() + static_cast<std::ptrdiff_t>(looked_at),
                   [&](const FrameRecord& r) { return r.device_frame == device_frame; });
  if (found == frames_.rbegin() + static_cast<std::ptrdiff_t>(looked_at)) return;
  found->gpu_ms = ms;
  found->gpu_shadows_ms = shadows_ms;
  if (pass_ms.size() != passes_.size()) return;
  const auto row = frames_.rend() - found - 1;
  std::ranges::transform(pass_ms, pass_ms_.begin() + row * std::ssize(passes_),
                         [](double value) { return static_cast<float>(value); });
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
  file.write(fmt::format(",{}", kColumnsAfterSystems));
  for (const std::string& pass : log.passes())
    file.write(fmt::format(",pass_{}_ms", pass));
  for (const FigureInfo& figure : log.figures())
    file.write(fmt::format(",{}{}", kOwnPrefix, figure.name));
  file.write(",marks\n");
  std::size_t mark = 0;
  for (std::size_t i = 0; i < log.frames().size(); ++i)
    file.write(row(log.frames()[i], log.system_ms(i)) + other_cells(log, i, mark));
  return file.commit();
}

}  // namespace psygen::telemetry
