// Comparison of frame times alone: captures of other tools, and psygen's runs by their frame times.
// Knows nothing about images, and needs no pairs. Judges captures as wholes: each gives one value
// of a figure. compare.hpp is sharper for psygen's runs. Pure, except for read_times().
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/captures/capture.hpp"
#include "engine/compare/compare.hpp"
#include "engine/core/error.hpp"

namespace psygen::compare {

// The times of one side, and sentences about files that hold none.
struct TimesSide {
  std::vector<captures::Capture> captures;
  std::vector<std::string> skipped;
};
// True for a file, for a folder with a readable capture of another tool at any depth, and for a
// folder that has files but no run of psygen. Files beside a frames.csv belong to its run.
bool holds_captures(const std::filesystem::path& path);

// Reads a capture, or all captures and psygen's runs in a folder at any depth, by name. Runs count
// by their frames after the warm-up. In a folder, .csv and .json files without frame times are
// skipped. Fails like captures::read() and read_run(), and if a folder has nothing to compare.
core::Result<TimesSide> read_times(const std::filesystem::path& path);

// One figure of all captures of both sides.
struct TimesFigure {
  std::string_view name, unit;
  bool gates = false;                    // it takes part in the verdict
  std::optional<double> a, b;            // medians over the captures; missing: too few frames
  std::optional<double> ratio, p;        // b / a; of a difference by chance, if both sides have 5
  std::optional<double> unseen_percent;  // smaller changes would stay unseen
  Verdict verdict = Verdict::kInconclusive;
};

struct TimesComparison {
  Verdict verdict = Verdict::kInconclusive;
  std::vector<std::string> reasons, warnings;  // sentences
  std::vector<TimesFigure> figures;
  TimesSide a, b;
};

// Fewest and most captures of a side for a verdict.
inline constexpr std::size_t kFewestCaptures = 5, kMaxCaptures = 100;
// A change of a wall time counts from 10 %; the same is said if 15 % would be seen.
inline constexpr double kTimesFloor = 1.10, kTimesWanted = 1.15;

// Compares the sides. Fails with kInvalidArgument if one has over kMaxCaptures captures.
core::Result<TimesComparison> compare_times(TimesSide a, TimesSide b);

// Text for the terminal, compare.json ("psygen.times/1"), and compare.html.
std::string to_text(const TimesComparison& comparison);
std::string to_json(const TimesComparison& comparison);
std::string to_html(const TimesComparison& comparison);

}  // namespace psygen::compare
