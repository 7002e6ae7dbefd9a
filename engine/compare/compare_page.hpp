// compare.html: a comparison for people. Shows the verdict as a sentence, effects with their
// intervals, and the frames of both sides overlaid, with zoom and values as in the report of a
// flight. Uses no external resources. Programs read compare.json. Pure.
#pragma once

#include <span>
#include <string>

#include "engine/compare/compare.hpp"

namespace psygen::compare {

// Names of the compared sides: a folder, or a command.
struct Sides {
  std::string a, b;
  std::string test;  // the frame test of both sides; may be empty
};

// Page of a comparison of `a` and `b` by compare(). `alarms` may be null.
std::string to_html(const Comparison& comparison, std::span<const RecordedRun> a,
                    std::span<const RecordedRun> b, const Sides& sides, const FalseAlarms* alarms);

// The verdict as a sentence: "B is worse: it shows less".
std::string headline(const Comparison& comparison);

}  // namespace psygen::compare
