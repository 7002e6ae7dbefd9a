// A flight of the camera: points in time over the ground, joined so that velocity and turn are
// smooth but where it jumps, read from TOML files (files/path_file.hpp). Heights are above the
// ground of whichever world is flown through. Not a simulation: any time can be asked for.
// Immutable; any thread.
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

struct PathPoint {
  double time_s = 0;
  glm::dvec2 at_m{0.0};  // x and z from the corner of the path's origin block
  double height_m = 2;   // above the ground
  // Where to look: at a heading, at a place, or, with neither, along the flight.
  std::optional<double> heading_deg;  // 0 along −Z (north), 90 along +X (east)
  std::optional<glm::dvec2> look_at_m;
  double pitch_deg = 0;  // upwards
  // The camera is here at once; until then it stands at the point before. Not of the first point.
  bool jump = false;
};

class CameraPath {
 public:
  // Of a point above the ground. Lower, and the nearest that is drawn cuts into slopes.
  static constexpr double kLeastHeightM = 0.5, kMostHeightM = 1e5;
  // The camera never comes nearer to the ground than this, or than its lowest point where that is
  // lower.
  static constexpr double kClearance_m = 2;

  struct Settings {
    std::string name;
    core::BlockCoord origin_block;
    // The height follows the highest ground within this time before and after, so that the flight
    // over rough ground is calm. In (0, 10].
    double smoothing_s = 1.5;
  };

  // At least one point, times strictly growing.
  CameraPath(Settings settings, std::vector<PathPoint> points);

  const std::string& name() const { return settings_.name; }
  const std::vector<PathPoint>& points() const { return points_; }
  // The time of the last point.
  double duration_seconds() const { return points_.back().time_s; }

  // Where the camera is at time `t` in seconds; the ends are held before the first and after the
  // last point (and the beginning for NaN). Normalised and valid. About 50 µs.
  core::CameraPose pose_at(double t, const World& world) const;

 private:
  // Points without a jump between them.
  struct Run {
    explicit Run(std::span<const PathPoint> points);
    double start_s;
    double clearance_m;  // from the ground
    Spline x, z, height, yaw, pitch;
  };
  const Run& run_at(double t) const;
  double smooth_ground_m(double t, const Run& run, const World& world, core::BlockCoord block,
                         double& ground_here_m) const;
  glm::dvec2 local_of(double t, const Run& run, double block_size_m, core::BlockCoord block) const;

  Settings settings_;
  std::vector<PathPoint> points_;
  std::vector<Run> runs_;  // by start
};

}  // namespace psygen::world
