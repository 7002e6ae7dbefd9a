// Frame times of the virtual clock: fixed costs for the work of a frame, similar to those of a
// software device on two current cores. Not a measurement of this machine and never fitted to one:
// the same frames take the same time everywhere, so that a change of the time is a change of the
// work. Pure.
#pragma once

#include <cstdint>

#include "engine/app/options.hpp"

namespace psygen::app {

// The published costs (docs/frame-tests.md). Another cost is another clock: earlier and later
// frames are then not comparable.
inline constexpr double kVirtualFrameMs = 0.5;        // of every frame
inline constexpr double kVirtualTriangleMs = 100e-6;  // 100 ns
inline constexpr double kVirtualDrawMs = 2e-3;        // 2 µs
inline constexpr double kVirtualPixelMs = 8e-6;       // 8 ns, of the landscape

// True if sessions with these options have virtual frame times.
inline bool has_virtual_frames(const SessionOptions& options) {
  return options.scene.virtual_time && options.headless;
}

// Milliseconds of a frame of this size with these triangles and draws. The landscape has a render
// scale of `resolution`.
inline double virtual_frame_ms(std::uint64_t triangles, std::uint32_t draws, core::Extent size,
                               double resolution = 1) {
  const auto width = static_cast<double>(size.width), height = static_cast<double>(size.height);
  return kVirtualFrameMs + kVirtualTriangleMs * static_cast<double>(triangles) +
         kVirtualDrawMs * static_cast<double>(draws) +
         kVirtualPixelMs * (width * height * resolution * resolution);
}

inline constexpr double kGapMs = 5000, kGapRatio = 20, kSuspendedSeconds = 0.05;

// Detects a stalled machine: suspended, stopped, or its clock went back. Such a time says nothing
// about a frame. `usual_ms`: time of the previous frame, 0: unknown. `suspended_s`: suspension
// during this frame.
inline bool is_gap(double frame_ms, double usual_ms, double suspended_s) {
  const bool stopped = usual_ms > 0 && frame_ms > kGapMs && frame_ms > kGapRatio * usual_ms;
  return stopped || frame_ms < 0 || suspended_s > kSuspendedSeconds;
}

}  // namespace psygen::app
