// Whether a flight drew what was requested, in words: holes, pictures that are too coarse, errors
// that were raised for lack of memory or time, models that failed. One judgement for the summary,
// the report and the terminal. Not about the speed of frames. Pure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/telemetry/summary.hpp"

namespace psygen::telemetry {

// How good the picture was, from best to worst after kUnknown.
enum class Grade {
  kUnknown,  // no frame was measured
  kGood,     // no hole, no failed model, at most kGoodPercent too coarse, no error raised for long
  kFair,     // coarser than requested
  kPoor,     // holes, failed models, or more than kPoorPercent too coarse
};
// "unknown", "good", "fair", "poor".
std::string_view name_of(Grade grade);

// Limits of the grades: the percentage of the picture that is missing or too coarse, at the 99th
// percentile of the frames (with fewer than 100 frames, the largest).
inline constexpr double kGoodPercent = 1.0, kPoorPercent = 10.0;
// The percentage of frames in which an error may be raised.
inline constexpr double kRaisedPercent = 1.0;

// The judgement of a run.
struct Verdict {
  Grade grade = Grade::kUnknown;
  std::string headline;              // two or three words
  std::vector<std::string> reasons;  // sentences: what was seen
  std::vector<std::string> advice;   // sentences: what to do; empty when nothing is wrong
};

// Judges the picture of a run. The worst finding decides the grade.
Verdict picture_verdict(const Summary& summary);

// What the figures of times leave out, as a sentence; empty if nothing.
std::string left_out_text(const Summary& summary);

}  // namespace psygen::telemetry
