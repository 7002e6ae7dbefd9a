// Detects a stalled machine: suspended, stopped, or its clock went back. Such a time says nothing
// about a frame. Pure.
#pragma once

namespace psygen::app {

inline constexpr double kGapMs = 5000, kGapRatio = 20, kSuspendedSeconds = 0.05;

// `usual_ms`: time of the previous frame, 0: unknown. `suspended_s`: suspension during this frame.
inline bool is_gap(double frame_ms, double usual_ms, double suspended_s) {
  const bool stopped = usual_ms > 0 && frame_ms > kGapMs && frame_ms > kGapRatio * usual_ms;
  return stopped || frame_ms < 0 || suspended_s > kSuspendedSeconds;
}

}  // namespace psygen::app
