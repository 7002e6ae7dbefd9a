// The figures of a run, field by field as in summary.json, and how they are made from a frame log
// and the facts that only the caller knows. Plain values; the statistics are in statistics.hpp.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/measured.hpp"

namespace psygen::telemetry {

inline constexpr std::string_view kSummarySchema = "psygen.summary/1";

using Count = Measured<std::uint64_t>;

// The world if it were all generated.
struct WorldFacts {
  std::string name;
  std::uint64_t seed = 0;
  std::array<std::int64_t, 2> blocks{};  // x, z; 0 = endless
  Count triangles;
  Count bytes_paper;  // with the 256 bytes per triangle of the paper
  Count bytes;        // in the engine's formats
};

struct DeviceFacts {
  std::string name;
  std::string driver;
  std::string api;  // "1.3.289"
};

struct RunSettings {
  std::string paradigm;  // "pla", "amplify", "lazy"
  std::string policy;    // of the schedule: "deadline", "plp", …
  std::uint32_t modelers = 0;
  std::uint32_t width = 0;   // pixels
  std::uint32_t height = 0;  // pixels
  bool lod = true;
  Figure fixed_step;  // Hz; missing when the flight follows the wall clock
};

struct RunFacts {
  WorldFacts world;
  DeviceFacts device;
  RunSettings run;
  std::uint64_t cache_budget_bytes = 0;
  Count cache_peak_bytes;  // where missing: the largest cache_bytes of the log
  Figure
      prefetch_hit_percent;  // of the models synthesised ahead of time, those that came into view
  Figure share_drawn;        // of all triangles synthesised, those of meshes that were ever drawn
  Figure floor_ratio;        // median frame ÷ the same draw lists replayed with nothing else
  Count peak_rss_bytes;
  Count world_hash;
  Count images_hash;
};

struct FrameTimes {
  Figure mean, p50, p95, p99, p999, max;
};

struct SystemTimes {
  std::string name;
  Figure p50, p99;
};

struct Summary {
  WorldFacts world;
  DeviceFacts device;
  struct : RunSettings {
    std::uint64_t frames = 0;           // of the whole run
    double seconds = 0;                 // of the whole run, on the flight's clock
    double warmup_seconds = 0;          // left out of all figures below
    std::uint64_t measured_frames = 0;  // what is left
  } run;
  FrameTimes frame_ms;
  Figure low1_fps;
  Count hitches;
  Figure stutter_percent;
  std::vector<SystemTimes> system_ms;
  struct {
    Count frames;      // frames with at least one hole
    Figure nodes_p99;  // holes and coarse nodes of a frame
    Figure pixels_p99_percent, pixels_max_percent;
    struct {
      Figure p50, p99, max;
    } time_to_visible_ms;
  } missing;
  struct {
    std::uint64_t budget_bytes = 0;
    Count peak_bytes;  // of the whole run: the budget holds during warm-up, too
    Count hits, misses, evictions, regenerations;
    Figure prefetch_hit_percent;
  } cache;
  struct {
    Count models, triangles, bytes;
    Figure seconds;               // busy time of all modelers together
    Figure share_drawn;           // of all triangles of the whole run, those ever drawn, in [0, 1]
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
  } memory;
  struct {
    Count world, images;
  } hash;
};

// All figures over the frames that start at `warmup_s` or later, on the flight's clock. Pure.
Summary summarise(const FrameLog& log, const RunFacts& facts, double warmup_s);

// summary.json as text with two spaces of indentation and a final newline. A missing figure is null
// and its reason stands in "reasons" under the field's path ("frame_ms.p999"). Hashes are strings
// of 16 hexadecimal digits. Bytes that are not UTF-8 in names are replaced.
std::string to_json(const Summary& summary);

// A table for people on a terminal, at most 78 columns, without colours.
std::string to_text(const Summary& summary);

// to_json into a file. Fails with kIo and the path.
core::Result<void> write_summary_json(const std::filesystem::path& path, const Summary& summary);

}  // namespace psygen::telemetry
