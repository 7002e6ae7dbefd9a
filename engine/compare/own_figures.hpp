// The game's figures of two sets of runs (engine/telemetry/own_figures.hpp): the mean of each side,
// and the probability of their difference by chance. They are shown beside the verdict and do not
// decide it: only the game knows whether more is worse; budgets of frame tests judge them. Pure.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace psygen::compare {

struct RecordedRun;

// A figure of one run.
struct RecordedFigure {
  std::string name, unit;
  std::optional<double> mean;  // over the run's frames; none: no frame had a value
};

// A figure of both sides, or the reason why it cannot be compared.
struct ComparedFigure {
  std::string name, unit;
  double a = 0, b = 0;  // means of the runs' means
  // Of a difference as large by chance, two-sided (mann_whitney()); 1 for a single run of each.
  double p = 1;
  std::string note;  // empty: a, b and p are known
};

// All figures of the runs, in the order of their first appearance. A figure that some runs lack or
// have in another unit gets a note. At most 100 runs of each side.
std::vector<ComparedFigure> compare_figures(std::span<const RecordedRun> a,
                                            std::span<const RecordedRun> b);

// "path_ms: 1.20 and 1.40 ms (B/A 1.167, p 0.004)", or the note.
std::string to_text(const ComparedFigure& figure);

}  // namespace psygen::compare
