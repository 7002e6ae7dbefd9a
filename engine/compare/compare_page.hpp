// compare.html: a comparison for people. The verdict in words, effects with their intervals, and
// the frames of both sides over each other, with zoom and values as in the report of a flight.
// Without external resources. Not for programs: compare.json is. Pure.
#pragma once

#include <span>
#include <string>

#include "engine/compare/compare.hpp"

namespace psygen::compare {

// What was compared, in words: a folder, or a command.
struct Sides {
  std::string a, b;
  std::string test;  // the frame test that both ran; may be empty
};

// The page of a comparison of `a` and `b`, which compare() took. `alarms` may be null.
std::string to_html(const Comparison& comparison, std::span<const RecordedRun> a,
                    std::span<const RecordedRun> b, const Sides& sides, const FalseAlarms* alarms);

// The verdict as a sentence: "B is worse: it shows less".
std::string headline(const Comparison& comparison);

}  // namespace psygen::compare
