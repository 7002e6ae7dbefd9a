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
double virtual_frame_ms(std::uint64_t triangles, std::uint32_t draws, core::Extent size,
                        double resolution = 1);

}  // namespace psygen::app
