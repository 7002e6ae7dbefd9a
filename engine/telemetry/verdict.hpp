// Verdict on the image quality of a flight: holes, coarse frames, errors raised for lack of memory
// or time, failed models. Shared by the summary, the report and the terminal. Does not judge frame
// times. Pure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/telemetry/summary.hpp"

namespace psygen::telemetry {

// Image quality, from best to worst after kUnknown.
enum class Grade {
  kUnknown,  // no frame was measured
  kGood,     // no hole, no failed model, at most kGoodPercent too coarse, error raised only briefly
  kFair,     // coarser than requested
  kPoor,     // holes, failed models, or more than kPoorPercent too coarse
};
// "unknown", "good", "fair", "poor".
std::string_view name_of(Grade grade);

// Limits of the grades: the percentage of the image that is missing or too coarse, at the 99th
// percentile of the frames (the largest, with fewer than 100 frames).
inline constexpr double kGoodPercent = 1.0, kPoorPercent = 10.0;
// Percentage of frames in which an error may be raised.
inline constexpr double kRaisedPercent = 1.0;

// Verdict on a run.
struct Verdict {
  Grade grade = Grade::kUnknown;
  std::string headline;              // two or three words
  std::vector<std::string> reasons;  // sentences: observations
  std::vector<std::string> advice;   // sentences: advice; empty if there is no fault
};

// Judges the image of a run. The worst finding decides the grade.
Verdict judge_quality(const Summary& summary);

// Sentence about frames that timing statistics exclude; empty if there are none.
std::string left_out_text(const Summary& summary);

}  // namespace psygen::telemetry
