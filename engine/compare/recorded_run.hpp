// A run as it lies in its folder: frames.csv and summary.json of a flight or a frame test. Reads
// and checks; judges nothing. Any thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace psygen::compare {

// A frame over 5 s, and over 20 times the median: the machine was suspended, or stood still.
inline constexpr double kSuspendedMs = 5000, kSuspendedRatio = 20;

struct RecordedRun {
  std::string folder;
  // Of every frame after the warm-up.
  std::vector<double> time_s, frame_ms;
  std::vector<double> cpu_ms;          // of the main thread; empty on the virtual clock
  std::vector<double> lacking, error;  // percent of the picture missing or too coarse; pixels
  std::vector<bool> left_out;          // set apart in frames.csv, or suspended
  std::size_t suspended = 0;           // how many frames
  double missing_percent = 0;          // mean over the frames, of the picture
  double coarse_percent = 0;           // likewise: drawn with over twice the requested error
  double error_pixels = 0;             // mean error of levels of detail ÷ resolution
  std::uint64_t holes = 0;             // sum over the frames
  bool virtual_clock = false;          // times are prices (docs/frame-tests.md)
  std::string world_hash, path_hash, images_hash;  // empty: there is none
  std::uint64_t width = 0, height = 0;             // pixels
  std::optional<double> fixed_step;                // Hz
};

// Reads a run. Fails with kIo for missing files, and with kParse, naming file, line and column, for
// what a run never writes: cut files, missing columns, cells that are not numbers, a clock that
// goes backwards.
core::Result<RecordedRun> read_run(const std::filesystem::path& folder);

// The same of texts in memory; `folder` is for messages.
core::Result<RecordedRun> parse_run(std::string_view frames_csv, std::string_view summary_json,
                                    const std::string& folder);

// The runs in a folder: itself, or its sub-folders (and theirs) that have a frames.csv, by name.
// Fails with kIo if there is none.
core::Result<std::vector<RecordedRun>> read_runs(const std::filesystem::path& folder);

}  // namespace psygen::compare
