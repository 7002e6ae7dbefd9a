// Turns the recorded poses of a camera into a path that flies through them. Pure, any thread.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/core/camera.hpp"
#include "engine/world/camera_path.hpp"

namespace psygen::world {

// A recorded pose. Times are seconds from any start and ascend strictly.
struct TimedPose {
  double time_s = 0;
  core::CameraPose pose;
};

// The maximum number of points in a path file.
inline constexpr std::size_t kMaxRecordedPoses = 10'000;

// A path through 1 to kMaxRecordedPoses valid poses. At the time of each pose the camera is there,
// within the limits of paths: at least 0.5 m above the ground and a pitch of at most 89°. Poses too
// far apart for a flight are joined by a jump. 50 µs a pose.
CameraPath recorded_path(const std::string& name, std::span<const TimedPose> poses,
                         const World& world);

}  // namespace psygen::world
