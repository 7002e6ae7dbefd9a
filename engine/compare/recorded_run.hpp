// A recorded run: frames.csv and summary.json of a flight or a frame test. Reads and validates
// them; judges nothing. Any thread.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/compare/own_figures.hpp"
#include "engine/core/error.hpp"

namespace psygen::compare {

// A named text, such as "CPU" and its model name.
struct NamedText {
  std::string name, text;
  friend bool operator==(const NamedText&, const NamedText&) = default;
};

struct RecordedRun {
  std::string folder;
  // For every frame after the warm-up.
  std::vector<double> time_s, frame_ms;
  std::vector<double> cpu_ms;           // of the main thread; empty on the virtual clock
  std::vector<double> lacking, error;   // percent of the image missing or too coarse; pixels
  std::vector<bool> left_out;           // excluded in frames.csv, or suspended
  std::size_t suspended = 0;            // number of suspended frames
  double missing_percent = 0;           // of the image, mean over the frames
  double coarse_percent = 0;            // same mean: drawn with over twice the requested error
  double error_pixels = 0;              // mean error of LODs ÷ render scale
  std::uint64_t holes = 0;              // sum over the frames
  bool virtual_clock = false;           // times are fixed costs (docs/frame-tests.md)
  std::string path_hash, images_hash;   // empty: none
  std::uint64_t width = 0, height = 0;  // pixels
  // Conditions that comparable runs share: world, size, and on the wall clock CPU, device, driver,
  // preset. Then those that are only shown: revision, compiler, load. "unknown" in older runs.
  std::vector<NamedText> required, shown;
  std::optional<double> fixed_step;     // Hz
  std::uint64_t measured_frames = 0;    // after the warm-up, as the summary tells it
  std::vector<RecordedFigure> figures;  // of the game
};

// The text of a file of a run. Fails with kIo, and with kOverBudget above 1 GiB.
core::Result<std::string> read_text(const std::filesystem::path& file);

// Texts of the files of a run.
struct RunFiles {
  std::string frames_csv, summary_json;
};

// Reads frames.csv and summary.json of a folder. Fails with kIo, naming the file.
core::Result<RunFiles> read_run_files(const std::filesystem::path& folder);

// Reads a run. Fails with kIo for missing files. Fails with kParse, naming file, line and column,
// for content that no run writes: truncated files, missing columns, cells that are not numbers, a
// clock that goes backwards.
core::Result<RecordedRun> read_run(const std::filesystem::path& folder);

// Parses a run from texts in memory; `folder` is for messages.
core::Result<RecordedRun> parse_run(std::string_view frames_csv, std::string_view summary_json,
                                    const std::string& folder);

// Parses the conditions of a run alone, without frames: hashes, size, step, and those that runs
// share or show. The summary does not tell whether the clock was virtual.
core::Result<RecordedRun> parse_conditions(std::string_view summary_json, const std::string& folder,
                                           bool virtual_clock);

// The runs in a folder: itself, or its subfolders at any depth that have a frames.csv, by name.
// Fails with kIo if there are none.
core::Result<std::vector<RecordedRun>> read_runs(const std::filesystem::path& folder);

// For each frame of the first run of `a`: true if some run of `a` or `b` excludes it.
std::vector<bool> left_out_of(std::span<const RecordedRun> a, std::span<const RecordedRun> b);

}  // namespace psygen::compare
