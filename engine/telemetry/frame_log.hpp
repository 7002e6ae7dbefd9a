// Log of the cost and content of each frame: one row per frame. The tick's last system fills the
// row, App::log_frame adds the times, and the rows are read when the run ends. Spans are in
// trace_log.hpp. Adding is O(1) and allocates only when memory is limited. Main thread only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/telemetry/marks.hpp"
#include "engine/telemetry/own_figures.hpp"

namespace psygen::telemetry {

// Samples of one quantity that arrive too often to store them all: thousands per second, each with
// its time. Stores all of them up to its capacity and a uniform choice beyond (reservoir sampling,
// Vitter 1985, algorithm R), deterministically. Memory is bounded; adding is O(1) and allocates
// only when the set doubles. One thread.
class SampleSet {
 public:
  // Stores at most `capacity` (at least 1) samples.
  explicit SampleSet(std::size_t capacity = std::size_t{1} << 17);

  // Adds a sample. Ignores one whose time or value is not finite.
  void add(double time_s, double value);
  // Number of added samples, stored or not.
  std::uint64_t added_count() const { return added_; }
  // Stored values with a time of at least `from_s` and below `until_s`, in no particular order. If
  // samples were dropped, the largest value of all is still included. O(capacity).
  std::vector<double> values_since(double from_s,
                                   double until_s = std::numeric_limits<double>::infinity()) const;

 private:
  struct Sample {
    double time_s;
    double value;
  };

  std::size_t capacity_;
  std::uint64_t added_ = 0;
  Sample largest_{0, 0};
  std::vector<Sample> samples_;
};

// Reason why timing statistics exclude a frame.
enum class Apart : std::uint8_t {
  kNo,
  kPicture,    // the frame was written to a file
  kAfterIdle,  // the GPU was idle before it (after writing an image), so waiting is shorter
  kResized,    // the window changed its size
  kNotDrawn,   // the window rejected the image
  kGap,        // the machine was suspended or stalled, or its clock went back
};
// The number of Apart values.
inline constexpr std::size_t kApartKinds = 6;
// "", "picture", "after_idle", "resized", "not_drawn", "gap".
std::string_view name_of(Apart apart);

// Name of the file for the image of frame `index`: "frame_00040.png".
std::string picture_name(std::uint64_t index);

// One row. Counts are those of this frame alone; "queued" and "cache_bytes" are the state at its
// end.
struct FrameRecord {
  std::uint64_t index = 0;
  double time_s = 0;  // start of the frame on the flight's clock; 0 is the flight's start
  // Wall time of pose, tick and plugins. For written images it includes the GPU's time.
  double frame_ms = 0;
  double main_cpu_ms = 0;        // CPU time of the main thread in this frame
  double device_wait_ms = 0;     // part of frame_ms: waiting for the frame before the last
  double acquire_ms = 0;         // part of frame_ms: waiting for an image of the window
  double present_ms = 0;         // part of frame_ms: waiting for the window to accept the image
  double record_ms = 0;          // the render system recording and submitting commands
  std::optional<double> gpu_ms;  // GPU time of this frame, by timestamps
  std::optional<double> gpu_shadows_ms;  // part of gpu_ms: shadow maps
  std::uint64_t device_frame = 0;        // the renderer's number of this frame; 0: none
  // Time by core::monotonic_seconds() at which the picture was given to the window; headless: to
  // the device; 0: it was not. Not a column. Then the time since that of the frame before, and the
  // step of the flight's clock minus this time.
  double handed_over_s = 0;
  std::optional<double> between_presents_ms, animation_error_ms;
  std::optional<std::uint64_t> device_bytes;  // of all device memory of the renderer
  Apart apart = Apart::kNo;
  bool has_picture = false;  // picture_name(index) is next to the log; not a column

  double error_pixels = 0;      // allowed error of LODs
  double memory_factor = 1;     // factor by which the geometry budget raised it
  double resolution = 1;        // render scale: fraction of the image's width and height
  std::uint64_t triangles = 0;  // submitted
  std::uint32_t draws = 0;
  std::uint32_t nodes_in_view = 0;
  std::uint32_t holes = 0;            // nodes in view without a mesh
  std::uint32_t coarse_nodes = 0;     // nodes in view more than one level too coarse
  double missing_pixels_percent = 0;  // of the image, covered by holes and coarse nodes
  double too_coarse_percent = 0;      // of the image, drawn with over twice the requested error

  std::uint64_t cache_bytes = 0;
  std::uint32_t cache_hits = 0;
  std::uint32_t cache_misses = 0;
  std::uint32_t cache_evictions = 0;
  std::uint32_t cache_regenerations = 0;  // misses of a model that was in the cache before

  std::uint32_t requests_queued = 0;
  std::uint32_t requests_refused = 0;  // for visible meshes, for lack of memory
  std::uint32_t requests_completed = 0;
  std::uint32_t models_failed = 0;       // could not be synthesised
  std::uint32_t models_synthesised = 0;  // completed and ready, without stale and failed ones
  std::uint64_t triangles_synthesised = 0;
  std::uint64_t bytes_synthesised = 0;
  double synthesis_seconds = 0;  // busy time of all modelers for these models

  // Total waiting time of this frame: for the GPU and for the window.
  double wait_ms() const { return device_wait_ms + acquire_ms + present_ms; }
};

// Rows of one run with the times of its systems and the game's own figures, and samples of
// quantities without a row.
class FrameLog {
 public:
  static constexpr std::size_t kMaxFrames = std::size_t{1} << 18;

  // `systems` are the names of the systems in the order of the tick, `figures` those of the game,
  // `passes` those of the renderer.
  // Reserves (without touching) address space for `max_frames` rows if that is a small part of the
  // available memory. Further frames are counted but not stored.
  explicit FrameLog(std::vector<std::string> systems, std::size_t max_frames = kMaxFrames,
                    std::vector<FigureInfo> figures = {}, std::vector<std::string> passes = {});

  // Appends a row. `system_ms` are the times of systems() in ms, without waiting for the GPU or the
  // display; `own` are the values of figures(), NaN if unknown. A list of another length is
  // dropped.
  void add(const FrameRecord& record, std::span<const float> system_ms = {},
           std::span<const double> own = {});
  // Sets a mark in the last row. Ignores marks of a frame that was not stored.
  void add_mark(std::string name);
  // Sets the GPU time of one of the last frames, which arrives later. Ignores frames that are not
  // among the last 16.
  // `pass_ms` are the times of passes(); a list of another length is dropped.
  void set_gpu_ms(std::uint64_t device_frame, double ms, double shadows_ms,
                  std::span<const double> pass_ms = {});
  // Records that a node was drawn for the first time `ms` after it came into view.
  void add_time_to_visible(double time_s, double ms) { time_to_visible_ms_.add(time_s, ms); }
  // Records that a model took `actual_s` when the cost model had predicted `predicted_s`. Ignored
  // unless actual_s > 0.
  void add_cost_error(double time_s, double predicted_s, double actual_s);

  // The systems' names, and the stored rows. Valid until the next add().
  std::span<const std::string> systems() const { return systems_; }
  std::span<const FrameRecord> frames() const { return frames_; }
  // Times of systems() in row `frame` of frames(), in ms; NaN if unknown.
  std::span<const float> system_ms(std::size_t frame) const {
    return std::span(system_ms_).subspan(frame * systems_.size(), systems_.size());
  }
  // The game's figures, and their values in row `frame` of frames(); NaN if unknown.
  std::span<const FigureInfo> figures() const { return figures_; }
  std::span<const double> own(std::size_t frame) const {
    return std::span(own_).subspan(frame * figures_.size(), figures_.size());
  }
  // The passes of the renderer, and their GPU times in row `frame` of frames(), in ms; NaN if
  // unknown.
  std::span<const std::string> passes() const { return passes_; }
  std::span<const float> pass_ms(std::size_t frame) const {
    return std::span(pass_ms_).subspan(frame * passes_.size(), passes_.size());
  }
  // The marks, in the order of time.
  std::span<const FrameMark> marks() const { return marks_; }
  // Rows of frames that start at `warmup_s` or later. Rows are in the order of time.
  std::span<const FrameRecord> frames_since(double warmup_s) const;
  // Number of frames that were counted but not stored.
  std::uint64_t dropped_frames() const { return dropped_; }
  // Samples of both quantities with their times.
  const SampleSet& time_to_visible_ms() const { return time_to_visible_ms_; }
  const SampleSet& cost_error_percent() const { return cost_error_percent_; }

 private:
  std::vector<std::string> systems_;
  std::size_t max_frames_;
  std::vector<FrameRecord> frames_;
  std::vector<float> system_ms_;  // of each row, in the order of systems_
  std::vector<FigureInfo> figures_;
  std::vector<double> own_;  // of each row, in the order of figures_
  std::vector<std::string> passes_;
  std::vector<float> pass_ms_;  // of each row, in the order of passes_
  std::vector<FrameMark> marks_;
  std::uint64_t dropped_ = 0;
  SampleSet time_to_visible_ms_;
  SampleSet cost_error_percent_;
};

// Writes frames.csv: a header line, then one line per frame, comma-separated, with a point as
// decimal mark. System columns are named `<system>_ms`, passes `pass_<name>_ms`, own figures
// `figures.<name>`; "marks" has the names of marks with blanks between. Unknown values are empty.
// Fails with kIo and the path.
core::Result<void> write_frames_csv(const std::filesystem::path& path, const FrameLog& log);

}  // namespace psygen::telemetry
