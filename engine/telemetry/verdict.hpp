// Whether a flight drew what it was asked for, in words: holes, pictures that are too coarse,
// errors that were raised for want of memory or time, models that failed. One judge for the
// summary, the report and the terminal. Pure. Not about how fast the frames were.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/telemetry/summary.hpp"

namespace psygen::telemetry {

enum class Grade {
  kUnknown,  // no frame was measured
  kGood,     // no hole, no failed model, at most kGoodPercent too coarse, no error raised for long
  kFair,     // coarser than asked for
  kPoor,     // holes, failed models, or more than kPoorPercent too coarse
};
// "unknown", "good", "fair", "poor".
std::string_view name_of(Grade grade);

// Of the picture missing or too coarse in 99 % of the frames; of less than 100 frames in all.
inline constexpr double kGoodPercent = 1.0, kPoorPercent = 10.0;
// Share of the frames in which an error may be raised, in percent.
inline constexpr double kRaisedPercent = 1.0;

struct Verdict {
  Grade grade = Grade::kUnknown;
  std::string headline;              // two or three words
  std::vector<std::string> reasons;  // sentences: what was seen
  std::vector<std::string> advice;   // sentences: what to do; none where nothing is wrong
};

Verdict picture_verdict(const Summary& summary);

// What is left out of the figures of times, as a sentence; empty if nothing is.
std::string left_out_text(const Summary& summary);

}  // namespace psygen::telemetry
