// What each frame cost and showed: one row per frame, filled by the tick's last system, timed and
// added by App::log_frame, read when the run ends. Adding allocates only where memory is
// limited. Main thread only.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/telemetry/sample_set.hpp"

namespace psygen::telemetry {

inline constexpr std::size_t kMaxSystems = 16;

// What sets a frame apart from the others: its time is in no figure of times.
enum class Apart : std::uint8_t {
  kNo,
  kPicture,    // it was written to a file
  kAfterIdle,  // the device had been waited for (a picture before it), so this frame waited less
  kResized,    // the window changed its size
  kNotDrawn,   // the window took no picture
};
inline constexpr std::size_t kApartKinds = 5;
// "", "picture", "after_idle", "resized", "not_drawn".
std::string_view name_of(Apart apart);

// Counts are those of this frame alone; "queued" and "cache_bytes" are the state at its end.
struct FrameRecord {
  std::uint64_t index = 0;
  double time_s = 0;       // start of the frame on the flight's clock; 0 is the flight's start
  double frame_ms = 0;     // wall time of pose, tick and plugins; for a picture of the device too
  double main_cpu_ms = 0;  // CPU time of the main thread in this frame
  double device_wait_ms = 0;             // of frame_ms: waiting for the frame before the last
  double acquire_ms = 0;                 // … for an image of the window
  double present_ms = 0;                 // … for the window to take the picture
  double record_ms = 0;                  // of the render system: recording and submitting commands
  std::optional<double> gpu_ms;          // of this frame on the device, by timestamps
  std::optional<double> gpu_shadows_ms;  // of these, for shadow maps
  std::uint64_t device_frame = 0;        // the renderer's number of this frame; 0: none
  Apart apart = Apart::kNo;
  // In the order of FrameLog::systems(), without waiting for the device or the display.
  std::array<float, kMaxSystems> system_ms{};

  double error_pixels = 0;      // that levels of detail might have
  double memory_factor = 1;     // of these, by how much the geometry budget raised it
  std::uint64_t triangles = 0;  // submitted
  std::uint32_t draws = 0;
  std::uint32_t nodes_in_view = 0;
  std::uint32_t holes = 0;            // nodes in view that are drawn at no level
  std::uint32_t coarse_nodes = 0;     // nodes in view coarser than wanted by more than one level
  double missing_pixels_percent = 0;  // of the picture, covered by holes and coarse nodes
  double too_coarse_percent = 0;      // of it, drawn with over twice the error that was asked for

  std::uint64_t cache_bytes = 0;
  std::uint32_t cache_hits = 0;
  std::uint32_t cache_misses = 0;
  std::uint32_t cache_evictions = 0;
  std::uint32_t cache_regenerations = 0;  // misses on a model that was in the cache before

  std::uint32_t requests_queued = 0;
  std::uint32_t requests_refused = 0;  // of what is in view, for want of memory
  std::uint32_t requests_completed = 0;
  std::uint32_t models_failed = 0;       // that could not be synthesised
  std::uint32_t models_synthesised = 0;  // completed and landed, without stale and failed ones
  std::uint64_t triangles_synthesised = 0;
  std::uint64_t bytes_synthesised = 0;
  double synthesis_seconds = 0;  // busy time of all modelers for these models

  double wait_ms() const { return device_wait_ms + acquire_ms + present_ms; }
};

class FrameLog {
 public:
  // Names of the systems in the order of the tick, at most kMaxSystems. Space for `max_frames` rows
  // is reserved (not touched) where that is a small part of the memory that the system has left.
  // Frames beyond it, or beyond what there is memory for, are counted but not kept.
  explicit FrameLog(std::vector<std::string> systems,
                    std::size_t max_frames = std::size_t{1} << 18);

  void add(const FrameRecord& record);
  // What the device took for one of the last frames; known only now. Others are ignored.
  void set_gpu_ms(std::uint64_t device_frame, double ms, double shadows_ms);
  // A node was drawn for the first time `ms` after it came into view.
  void add_time_to_visible(double time_s, double ms) { time_to_visible_ms_.add(time_s, ms); }
  // A model took `actual_s` where the cost model had said `predicted_s`.
  void add_cost_error(double time_s, double predicted_s, double actual_s);

  std::span<const std::string> systems() const { return systems_; }
  std::span<const FrameRecord> frames() const { return frames_; }
  // The frames that start at `warmup_s` or later.
  std::span<const FrameRecord> frames_since(double warmup_s) const;
  std::uint64_t dropped_frames() const { return dropped_; }
  const SampleSet& time_to_visible_ms() const { return time_to_visible_ms_; }
  const SampleSet& cost_error_percent() const { return cost_error_percent_; }

 private:
  std::vector<std::string> systems_;
  std::size_t max_frames_;
  std::vector<FrameRecord> frames_;
  std::uint64_t dropped_ = 0;
  SampleSet time_to_visible_ms_;
  SampleSet cost_error_percent_;
};

// frames.csv: a header line, then one line per frame, comma-separated, point as decimal mark.
// System columns are called `<system>_ms`; what is not known is empty. Fails with kIo and the path.
core::Result<void> write_frames_csv(const std::filesystem::path& path, const FrameLog& log);

}  // namespace psygen::telemetry
