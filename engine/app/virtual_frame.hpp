// What a frame takes on the virtual clock: fixed prices for what it draws, about those of a
// software device on two cores of today. Not a measurement of this machine, and never fitted to
// one: the same pictures take the same time everywhere, so that a change of the time is a change of
// the work. Pure.
#pragma once

#include <cstdint>

#include "engine/app/options.hpp"

namespace psygen::app {

// The published prices (docs/frame-tests.md). Another price is another clock: frames of before and
// after cannot be compared.
inline constexpr double kVirtualFrameMs = 0.5;        // of every frame
inline constexpr double kVirtualTriangleMs = 100e-6;  // 100 ns
inline constexpr double kVirtualDrawMs = 2e-3;        // 2 µs
inline constexpr double kVirtualPixelMs = 8e-6;       // 8 ns, of the landscape

// Whether the frames of a session with these options have such times.
inline bool has_virtual_frames(const SessionOptions& options) {
  return options.scene.virtual_time && options.headless;
}

// The milliseconds of a frame of this size that submits these triangles in these draws. The
// landscape has `resolution` of its width and height.
double virtual_frame_ms(std::uint64_t triangles, std::uint32_t draws, core::Extent size,
                        double resolution = 1);

}  // namespace psygen::app
