// A flight of the camera: points in time over the ground. Velocity and rotation are smooth except
// at jumps. Read from TOML files (files/path_file.hpp). Heights are above the ground of the world
// that the camera flies through. pose_at() works for any time in any order; nothing is simulated.
// Immutable, any thread.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/camera.hpp"
#include "engine/world/spline.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {

// One point of a path.
struct PathPoint {
  double time_s = 0;
  glm::dvec2 at_m{0.0};  // x and z from the corner of the path's origin block
  double height_m = 2;   // above the ground
  // The view direction: a heading, a point to look at, or, with neither, the direction of flight.
  std::optional<double> heading_deg;  // 0 along −Z (north), 90 along +X (east)
  std::optional<glm::dvec2> look_at_m;
  double pitch_deg = 0;  // upwards
  // The camera stays at the previous point until this time and then jumps here. Not for the first
  // point.
  bool jump = false;
};

// A whole flight.
class CameraPath {
 public:
  // Range of a point's height. Below it, the near plane would cut into slopes.
  static constexpr double kMinHeightM = 0.5, kMaxHeightM = 1e5;
  // Smallest distance of the camera from the ground. If a point between two jumps is lower, the
  // path between them uses the height of that point instead.
  static constexpr double kClearance_m = 2;

  // Settings of the whole path.
  struct Settings {
    std::string name;
    core::BlockCoord origin_block;
    // The height follows the highest ground within this time before and after, so flights over
    // rough ground stay calm. In (0, 10].
    double smoothing_s = 1.5;
  };

  // At least one point; times grow strictly. Linear in the points.
  CameraPath(Settings settings, std::vector<PathPoint> points);

  // The arguments of the constructor.
  const Settings& settings() const { return settings_; }
  const std::string& name() const { return settings_.name; }
  const std::vector<PathPoint>& points() const { return points_; }
  // The time of the last point.
  double duration_seconds() const { return points_.back().time_s; }

  // A hash of everything that affects the poses, without the name. The same on every machine.
  std::uint64_t hash() const;

  // The pose at time `t` in seconds: normalised and valid. Before the first and after the last
  // point it is the pose of that point; NaN gives the first pose. About 50 µs.
  core::CameraPose pose_at(double t, const World& world) const;

  // True if one of the path's points is over the world or less than `reach_m` beside it. Linear in
  // the points.
  bool comes_within(double reach_m, const World& world) const;

 private:
  // Successive points without a jump between them.
  struct Run {
    explicit Run(std::span<const PathPoint> points);
    double start_s;
    double clearance_m;  // smallest distance from the ground
    Spline x, z, height, yaw, pitch;
  };
  const Run& run_at(double t) const;
  double smooth_ground_m(double t, const Run& run, const World& world, core::BlockCoord block,
                         double& ground_here_m) const;
  glm::dvec2 local_of(double t, const Run& run, double block_size_m, core::BlockCoord block) const;

  Settings settings_;
  std::vector<PathPoint> points_;
  std::vector<Run> runs_;  // ordered by start_s
};

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
