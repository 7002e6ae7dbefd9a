// Measurements of a run, field by field as in summary.json, computed from a frame log and from
// facts that only the caller has. Plain values; statistics are defined in statistics.hpp, the
// verdict in verdict.hpp. Any thread.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/machine.hpp"
#include "engine/telemetry/marks.hpp"
#include "engine/telemetry/own_figures.hpp"
#include "engine/telemetry/reference_load.hpp"
#include "engine/telemetry/statistics.hpp"

namespace psygen::telemetry {

// Name and version of summary.json's format.
inline constexpr std::string_view kSummarySchema = "psygen.summary/1";

// A measured count of items or bytes.
using Count = Measured<std::uint64_t>;

// The complete world, if all of it were synthesised.
struct WorldFacts {
  std::string name;
  std::uint64_t seed = 0;
  std::array<std::int64_t, 2> blocks{};  // x, z; 0 = endless
  Count triangles;
  Count bytes_paper;  // at the paper's 256 bytes per triangle
  Count bytes;        // in the engine's formats
  // Means over the world's blocks, and a block's side in metres; 0: unknown.
  double block_m = 0, block_models = 0, block_triangles = 0, block_bytes = 0;

  // True if the world is endless along x or z.
  bool endless() const { return blocks[0] == 0 || blocks[1] == 0; }
  // Mean per square kilometre, e.g. per_km2(block_triangles); 0 if a block's side is unknown.
  double per_km2(double of_a_block) const {
    return block_m > 0 ? of_a_block * 1e6 / (block_m * block_m) : 0.0;
  }
};

// The GPU that drew the run.
struct DeviceFacts {
  std::string name;
  std::string driver;
  std::string api;          // "1.3.289"
  bool timestamps = false;  // it can measure its own time
  bool pass_times = false;  // and that of each pass
};

// Options of the run.
struct RunSettings {
  std::string path;      // name of the camera path; empty: none
  std::string paradigm;  // "pla", "amplify", "lazy"
  std::string policy;    // of scheduling: "deadline", "plp", …
  std::uint32_t modelers = 0;
  std::uint32_t width = 0;   // pixels
  std::uint32_t height = 0;  // pixels
  bool lod = true;
  Figure fixed_step;        // Hz; missing when the flight follows the wall clock
  double error_pixels = 0;  // requested error of LODs
  Figure target_fps;        // held by raising the error; missing if none is held
  // Only for the report: the program with its arguments, and the view distance (0: unknown).
  std::string command = {};
  std::string preset = {};  // quality preset by name
  double view_distance_m = 0;
};

// Facts that the log does not contain.
struct RunFacts {
  WorldFacts world;
  DeviceFacts device;
  MachineFacts machine;
  BuildFacts build;
  LoadFacts load;
  ReferenceLoad reference;  // mean of before and after the run
  RunSettings run;
  std::uint64_t cache_budget_bytes = 0;
  Count cache_peak_bytes;       // if missing: the largest cache_bytes of the log
  Figure prefetch_hit_percent;  // percentage of prefetched models that came into view
  Figure share_drawn;  // fraction of all synthesised triangles whose meshes were ever drawn
  Figure floor_ratio;  // median frame ÷ the same draw lists replayed alone
  Count peak_rss_bytes;
  Count world_hash;
  Count types_hash;  // of all model types
  Count path_hash;
  Count images_hash;
  std::vector<SectionRange> sections;         // parts of the run with their own statistics
  std::vector<std::uint64_t> invalid_values;  // of each own figure: values that were not finite
  std::uint64_t ignored_marks = 0;            // Marks::ignored()
};

// Statistics of one quantity; "pNN" are percentiles.
struct FrameTimes {
  Figure mean, p50, p95, p99, p999, max;
};

// The same without p999.
struct Distribution {
  Figure mean, p50, p95, p99, max;
};

// The GPU times of one pass of the renderer.
struct PassTimes {
  std::string name;
  Figure p50, p99, max;
};

// Median and 99th percentile.
struct Spread {
  Figure p50, p99;
};

// The times of one system of the tick.
struct SystemTimes {
  std::string name;
  Figure p50, p99;  // without waiting for the GPU or the display
};

// Figures of a run divided by those of its reference load: processor time by that of all three
// parts, frame times by the wall time of `pair`.
struct ReferenceRatios {
  Figure cpu, frame_p50, frame_p99;
};

// Statistics of a game's figure over the frames with a value: timed frames for durations, measured
// ones for others.
struct OwnFigureTimes {
  FigureInfo info;
  std::uint64_t frames = 0;   // with a value
  std::uint64_t invalid = 0;  // values of the whole run that were not finite
  Figure mean, min, p50, p95, p99, max;
};

// A mark of the game: how often it was set, and where first.
struct MarkFacts {
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t frame = 0;  // FrameRecord::index
  double time_s = 0;        // of that frame's start
};

struct Section;

// A frame counts as too coarse if more than this percentage of its image is missing or too coarse.
inline constexpr double kCoarsePercent = 1.0;

// All statistics of a run. "Measured" frames start after the warm-up; "timed" frames are measured
// frames without a reason for exclusion.
struct Summary {
  WorldFacts world;
  DeviceFacts device;
  MachineFacts machine;
  BuildFacts build;
  LoadFacts load;
  ReferenceLoad reference;
  struct : RunSettings {
    std::uint64_t frames = 0;           // of the whole run
    double seconds = 0;                 // of the whole run, on the flight's clock
    double warmup_seconds = 0;          // excluded from all statistics below
    std::uint64_t measured_frames = 0;  // frames after the warm-up
    // Number of measured frames in timing statistics, and numbers of measured frames by reason for
    // exclusion.
    std::uint64_t timed_frames = 0;
    std::array<std::uint64_t, kApartKinds> apart_frames{};  // by Apart; [0] are the timed ones
    Figure real_seconds;                                    // wall time of all measured frames
    double measured_seconds = 0;                            // the same frames on the flight's clock
  } run;
  // Times of the timed frames alone.
  FrameTimes frame_ms;
  struct {
    Spread all, device, acquire, present;
  } wait_ms;
  Spread record_ms;  // render system: recording and submitting commands
  struct {
    Figure p50, p99, max, shadows_p50;
  } gpu_ms;  // on the device
  std::vector<PassTimes> pass_ms;
  Distribution between_presents_ms;
  Distribution animation_error_ms;  // of the absolute values
  Figure low1_fps, low01_fps;
  Count hitches;
  Figure stutter_percent;
  std::vector<SystemTimes> system_ms;
  struct {
    Count frames;      // frames with at least one hole
    Figure nodes_p99;  // holes and coarse nodes per frame
    Figure pixels_p99_percent, pixels_max_percent;
    // Of max(missing_pixels_percent, too_coarse_percent) per frame. Frames with more than
    // kCoarsePercent, and their total length on the flight's clock.
    Figure coarse_p99_percent, coarse_max_percent;
    Count coarse_frames;
    Figure coarse_seconds;
    struct {
      Figure p50, p99, max;
    } time_to_visible_ms;
  } missing;
  struct {
    Figure p50_pixels, max_pixels;              // allowed error of LODs
    Figure resolution_p50, resolution_min;      // FrameRecord::resolution
    Count raised_by_memory, raised_for_target;  // frames in which the error was raised
    Count refused_frames;                       // frames in which a visible mesh got no memory
  } detail;
  struct {
    std::uint64_t budget_bytes = 0;
    Count peak_bytes;  // of the whole run: the budget holds during warm-up too
    Count hits, misses, evictions, regenerations;
    Figure prefetch_hit_percent;
  } cache;
  struct {
    Count models, triangles, bytes;
    Count failed;                 // models of the whole run whose synthesis failed
    Figure seconds;               // busy time of all modelers
    Figure busy_percent;          // as a fraction of all modelers' real time
    Figure coarse_busy_percent;   // in frames more than kCoarsePercent too coarse
    Figure share_drawn;           // fraction of the run's triangles that were ever drawn, in [0, 1]
    Figure triangles_per_second;  // per busy second of one modeler
    struct {
      Figure p50, p95;
    } cost_error_percent;
  } synthesis;
  struct {
    Figure triangles_p50, draws_p50, floor_ratio;
  } draw;
  struct {
    Count peak_rss_bytes;
    Count device_peak_bytes;  // of the renderer's device memory, in the measured frames
  } memory;
  struct {
    Count world, types, path, images;
  } hash;
  std::vector<OwnFigureTimes> figures;  // of the game, in the order of their declaration
  std::vector<MarkFacts> marks;         // in the order of their first frames
  std::uint64_t ignored_marks = 0;
  std::vector<Section> sections;
};

// Missing if one of both figures is.
ReferenceRatios reference_ratios(const Summary& summary);

// Statistics of a part of a run. In `frames`, only fields that are measured per frame are filled.
struct Section {
  SectionRange range;
  std::string missing;  // the reason why there are no statistics; empty: there are
  Figure start_s, end_s;
  Summary frames;
};

// Rows of a section in a log, or the reason why there are none: a missing mark.
Measured<std::pair<std::size_t, std::size_t>> find_section(const FrameLog& log,
                                                           const SectionRange& range);

// Statistics over the frames that start at `warmup_s` or later on the flight's clock. Pure.
// O(frames log frames).
Summary summarise(const FrameLog& log, const RunFacts& facts, double warmup_s);

// summary.json as text, indented by two spaces, with a final newline. A missing number is null, and
// "reasons" has its reason under the field's path ("frame_ms.p999"). Hashes are strings of 16
// hexadecimal digits. Bytes that are not UTF-8 are replaced.
std::string to_json(const Summary& summary);

// Table for the terminal, at most 78 columns wide, without colours.
std::string to_text(const Summary& summary);

}  // namespace psygen::telemetry
