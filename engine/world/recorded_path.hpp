// Poses of a camera as it was moved, as a path that flies through them again. Pure, any thread.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/core/camera.hpp"
#include "engine/world/camera_path.hpp"

namespace psygen::world {

// Where a camera was. Times are seconds from any start and grow strictly.
struct TimedPose {
  double time_s = 0;
  core::CameraPose pose;
};

// The most points of a path file.
inline constexpr std::size_t kMaxRecordedPoses = 10'000;

// At least one valid pose, at most kMaxRecordedPoses. At the time of each pose the camera is
// there, within the limits of paths: at least 0.5 m above the ground, and 89° up and down. A
// distance that no flight may have is a jump. 50 µs a pose.
CameraPath recorded_path(const std::string& name, std::span<const TimedPose> poses,
                         const World& world);

}  // namespace psygen::world
