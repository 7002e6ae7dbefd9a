// What each frame cost and showed: one row per frame, filled by the tick's last system, timed and
// added by App::record_frame, read when the run ends. Adding allocates only where memory is
// limited. Main thread only.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/telemetry/sample_set.hpp"

namespace psygen::telemetry {

inline constexpr std::size_t kMaxSystems = 16;

// Counts are those of this frame alone; "queued" and "cache_bytes" are the state at its end.
struct FrameRecord {
  std::uint64_t index = 0;
  double time_s = 0;       // start of the frame on the flight's clock; 0 is the flight's start
  double frame_ms = 0;     // wall time of pose, tick and plugins; for a picture of the device too
  double main_cpu_ms = 0;  // CPU time of the main thread in this frame
  double wait_ms = 0;      // of frame_ms: waiting for the GPU, a swapchain image or vsync
  double gpu_ms = 0;  // by timestamps, of the newest frame that is known; 0: unknown, or software
  std::array<float, kMaxSystems> system_ms{};  // in the order of FrameLog::systems()

  double error_pixels = 0;      // that levels of detail might have
  std::uint64_t triangles = 0;  // submitted
  std::uint32_t draws = 0;
  std::uint32_t nodes_in_view = 0;
  std::uint32_t holes = 0;            // nodes in view that are drawn at no level
  std::uint32_t coarse_nodes = 0;     // nodes in view coarser than wanted by more than one level
  double missing_pixels_percent = 0;  // of the picture, covered by holes and coarse nodes

  std::uint64_t cache_bytes = 0;
  std::uint32_t cache_hits = 0;
  std::uint32_t cache_misses = 0;
  std::uint32_t cache_evictions = 0;
  std::uint32_t cache_regenerations = 0;  // misses on a model that was in the cache before

  std::uint32_t requests_queued = 0;
  std::uint32_t requests_completed = 0;
  std::uint32_t models_synthesised = 0;  // completed and landed, without stale and failed ones
  std::uint64_t triangles_synthesised = 0;
  std::uint64_t bytes_synthesised = 0;
  double synthesis_seconds = 0;  // busy time of all modelers for these models
};

class FrameLog {
 public:
  // Names of the systems in the order of the tick, at most kMaxSystems. Space for `max_frames` rows
  // is reserved (not touched) where that is a small part of the memory that the system has left.
  // Frames beyond it, or beyond what there is memory for, are counted but not kept.
  explicit FrameLog(std::vector<std::string> systems,
                    std::size_t max_frames = std::size_t{1} << 18);

  void add(const FrameRecord& record);
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
// System columns are called `<system>_ms`. Fails with kIo and the path.
core::Result<void> write_frames_csv(const std::filesystem::path& path, const FrameLog& log);

}  // namespace psygen::telemetry
