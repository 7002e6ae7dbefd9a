// What each frame cost and showed: one row per frame. The tick's last system fills the row,
// App::log_frame times and adds it, and the rows are read when the run ends. Not a trace
// (trace_log.hpp has the spans). Adding is O(1) and allocates only when memory is limited. Main
// thread only.
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

// What sets a frame apart from the others: its time is excluded from all figures of times.
enum class Apart : std::uint8_t {
  kNo,
  kPicture,    // it was written to a file
  kAfterIdle,  // the device had been waited for (after a picture): a shorter wait
  kResized,    // the window changed its size
  kNotDrawn,   // the window did not take the picture
  kGap,        // the machine was suspended or stood still, or its clock went back
};
// The number of Apart values.
inline constexpr std::size_t kApartKinds = 6;
// "", "picture", "after_idle", "resized", "not_drawn", "gap".
std::string_view name_of(Apart apart);

// The file that a flight writes the picture of frame `index` to: "frame_00040.png".
std::string picture_name(std::uint64_t index);

// One row. Counts are those of this frame alone; "queued" and "cache_bytes" are the state at its
// end.
struct FrameRecord {
  std::uint64_t index = 0;
  double time_s = 0;          // start of the frame on the flight's clock; 0 is the flight's start
  double frame_ms = 0;        // wall time of pose, tick and plugins; for a picture also the device
  double main_cpu_ms = 0;     // CPU time of the main thread in this frame
  double device_wait_ms = 0;  // part of frame_ms: waiting for the frame before the last
  double acquire_ms = 0;      // part of frame_ms: waiting for an image of the window
  double present_ms = 0;      // part of frame_ms: waiting for the window to take the picture
  double record_ms = 0;       // the render system recording and submitting commands
  std::optional<double> gpu_ms;          // this frame on the device, by timestamps
  std::optional<double> gpu_shadows_ms;  // part of gpu_ms: shadow maps
  std::uint64_t device_frame = 0;        // the renderer's number of this frame; 0: none
  Apart apart = Apart::kNo;
  bool has_picture = false;  // picture_name(index) is beside the log; not a column

  double error_pixels = 0;      // that levels of detail may have
  double memory_factor = 1;     // factor by which the geometry budget raised it
  double resolution = 1;        // share of the picture's width and height that the landscape has
  std::uint64_t triangles = 0;  // submitted
  std::uint32_t draws = 0;
  std::uint32_t nodes_in_view = 0;
  std::uint32_t holes = 0;            // nodes in view for which nothing is drawn
  std::uint32_t coarse_nodes = 0;     // nodes in view more than one level coarser than wanted
  double missing_pixels_percent = 0;  // of the picture, covered by holes and coarse nodes
  double too_coarse_percent = 0;      // of the picture, drawn with over twice the requested error

  std::uint64_t cache_bytes = 0;
  std::uint32_t cache_hits = 0;
  std::uint32_t cache_misses = 0;
  std::uint32_t cache_evictions = 0;
  std::uint32_t cache_regenerations = 0;  // misses on a model that was in the cache before

  std::uint32_t requests_queued = 0;
  std::uint32_t requests_refused = 0;  // for things in view, for lack of memory
  std::uint32_t requests_completed = 0;
  std::uint32_t models_failed = 0;       // could not be synthesised
  std::uint32_t models_synthesised = 0;  // completed and landed, without stale and failed ones
  std::uint64_t triangles_synthesised = 0;
  std::uint64_t bytes_synthesised = 0;
  double synthesis_seconds = 0;  // busy time of all modelers for these models

  // All waiting in this frame: for the device and for the window.
  double wait_ms() const { return device_wait_ms + acquire_ms + present_ms; }
};

// The rows of one run with the times of its systems, and samples of quantities that have no row.
class FrameLog {
 public:
  // `systems` are the names of the systems in the order of the tick. Address space for `max_frames`
  // rows is reserved (not touched) when it is a small part of the memory that the system has left.
  // Frames beyond it, or beyond the memory, are counted but not kept.
  explicit FrameLog(std::vector<std::string> systems,
                    std::size_t max_frames = std::size_t{1} << 18);

  // Appends a row. `system_ms` are the times of systems() in ms, without waiting for the device or
  // the display. Of another number of systems none is kept: they are not those of the log.
  void add(const FrameRecord& record, std::span<const float> system_ms = {});
  // Adds what the device took for one of the last frames, which is known only later. Ignores frames
  // that are not among the last 16.
  void set_gpu_ms(std::uint64_t device_frame, double ms, double shadows_ms);
  // A node was drawn for the first time `ms` after it came into view.
  void add_time_to_visible(double time_s, double ms) { time_to_visible_ms_.add(time_s, ms); }
  // A model took `actual_s` when the cost model had predicted `predicted_s`. Ignored unless
  // actual_s > 0.
  void add_cost_error(double time_s, double predicted_s, double actual_s);

  // The systems' names, and the rows kept. Valid until the next add().
  std::span<const std::string> systems() const { return systems_; }
  std::span<const FrameRecord> frames() const { return frames_; }
  // The times of systems() in row `frame` of frames(), in ms; NaN where they are unknown.
  std::span<const float> system_ms(std::size_t frame) const {
    return std::span(system_ms_).subspan(frame * systems_.size(), systems_.size());
  }
  // The rows of frames that start at `warmup_s` or later. Rows are in the order of time.
  std::span<const FrameRecord> frames_since(double warmup_s) const;
  // How many frames were counted but not kept.
  std::uint64_t dropped_frames() const { return dropped_; }
  // Samples of both quantities, at the times at which they were added.
  const SampleSet& time_to_visible_ms() const { return time_to_visible_ms_; }
  const SampleSet& cost_error_percent() const { return cost_error_percent_; }

 private:
  std::vector<std::string> systems_;
  std::size_t max_frames_;
  std::vector<FrameRecord> frames_;
  std::vector<float> system_ms_;  // of each row, in the order of systems_
  std::uint64_t dropped_ = 0;
  SampleSet time_to_visible_ms_;
  SampleSet cost_error_percent_;
};

// Writes frames.csv: a header line, then one line per frame, comma-separated, with a point as
// decimal mark. System columns are named `<system>_ms`; unknown values are empty. Fails with kIo
// and the path.
core::Result<void> write_frames_csv(const std::filesystem::path& path, const FrameLog& log);

}  // namespace psygen::telemetry
