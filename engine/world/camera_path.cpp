#include "engine/world/camera_path.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <numbers>

#include "engine/core/assert.hpp"
#include "engine/core/hash.hpp"
#include "engine/models/terrain/terrain.hpp"

namespace psygen::world {
namespace {

// Number of ground samples within smoothing_s.
constexpr int kSteps = 8;

Spline spline_of(std::span<const PathPoint> points, const auto& value_of) {
  std::vector<double> times, values;
  for (const PathPoint& point : points) {
    times.push_back(point.time_s);
    values.push_back(value_of(point));
  }
  return {times, values};
}

// Heading of a direction in x and z, in radians; `otherwise` for a direction of length 0.
double heading_of(glm::dvec2 direction, double otherwise) {
  return glm::length(direction) > 1e-6 ? std::atan2(direction.x, -direction.y) : otherwise;
}

// Between two points with a heading, the camera turns by their difference as written. All other
// turns take the shorter way.
std::vector<double> yaws_of(std::span<const PathPoint> points, const Spline& x, const Spline& z) {
  std::vector<double> yaws;
  bool written_before = false;
  for (const PathPoint& point : points) {
    const double before = yaws.empty() ? 0 : yaws.back();
    double yaw = 0;
    if (point.heading_deg) {
      yaw = glm::radians(*point.heading_deg);
    } else if (point.look_at_m) {
      yaw = heading_of(*point.look_at_m - point.at_m, before);
    } else {
      yaw = heading_of({x.slope(point.time_s), z.slope(point.time_s)}, before);
    }
    if (!yaws.empty() && !(written_before && point.heading_deg))
      yaw = before + std::remainder(yaw - before, 2 * std::numbers::pi);
    written_before = point.heading_deg.has_value();
    yaws.push_back(yaw);
  }
  return yaws;
}

// The cubic B-spline; 0 outside (−2, 2).
double b_spline(double u) {
  const double a = std::abs(u);
  if (a >= 2) return 0;
  return a < 1 ? 2.0 / 3 - a * a * (1 - a / 2) : (2 - a) * (2 - a) * (2 - a) / 6;
}

constexpr double kRecordedSmoothing_s = 0.1;  // the minimum, so poses stay near the recorded ones
constexpr double kLeap_m_s = 1900;            // path files allow at most 2000
constexpr double kMaxHeading_deg = 36'000, kMaxPitch_deg = 89;
constexpr double kProbeHeight_m = 1000;  // higher than any clearance

// `heading` within half a turn of the one before.
double unwrapped(double heading, double before) {
  return before + std::remainder(heading - before, 360.0);
}

}  // namespace

CameraPath::CameraPath(Settings settings, std::vector<PathPoint> points)
    : settings_(std::move(settings)), points_(std::move(points)) {
  PSYGEN_ASSERT(!points_.empty(), "a path needs a point");
  PSYGEN_ASSERT(settings_.smoothing_s > 0, "the smoothing time must be positive");
  for (auto first = points_.begin(); first != points_.end();) {
    const auto end = std::find_if(first + 1, points_.end(), std::mem_fn(&PathPoint::jump));
    runs_.emplace_back(std::span(first, end));
    first = end;
  }
}

CameraPath::Run::Run(std::span<const PathPoint> points)
    : start_s(points.front().time_s),
      clearance_m(
          std::min(kClearance_m, std::ranges::min(points, {}, &PathPoint::height_m).height_m)),
      x(spline_of(points, [](const PathPoint& p) { return p.at_m.x; })),
      z(spline_of(points, [](const PathPoint& p) { return p.at_m.y; })),
      height(spline_of(points, [](const PathPoint& p) { return p.height_m; })),
      pitch(spline_of(points, [](const PathPoint& p) { return glm::radians(p.pitch_deg); })) {
  const std::vector<double> yaws = yaws_of(points, x, z);
  yaw = spline_of(points, [&](const PathPoint& p) {
    return yaws[static_cast<std::size_t>(&p - points.data())];
  });
}

const CameraPath::Run& CameraPath::run_at(double t) const {
  const auto after = std::ranges::upper_bound(runs_, t, {}, &Run::start_s);
  return after == runs_.begin() ? runs_.front() : *std::prev(after);
}

// The position on the path at time `t`, in metres from the corner of `block`.
glm::dvec2 CameraPath::local_of(double t, const Run& run, double block_size_m,
                                core::BlockCoord block) const {
  const glm::dvec3 corner = core::offset_m(settings_.origin_block, {block, {}}, block_size_m);
  return {corner.x + run.x.value(t), corner.z + run.z.value(t)};
}

// The height of a smooth curve above the ground along the path. Samples lie at fixed times. Each is
// the highest ground within smoothing_s, and a smooth kernel of the same width averages them. Every
// sample is at least as high as the samples around `t`, so the average is too.
double CameraPath::smooth_ground_m(double t, const Run& run, const World& world,
                                   core::BlockCoord block, double& ground_here_m) const {
  const double step = settings_.smoothing_s / kSteps;
  const double first = std::floor(t / step) - 2 * kSteps;
  constexpr int kCount = 4 * kSteps + 2;
  std::array<glm::dvec2, kCount + 1> points;
  for (int i = 0; i < kCount; ++i)
    points[static_cast<std::size_t>(i)] =
        local_of((first + i) * step, run, world.block_size_m(), block);
  points[kCount] = local_of(t, run, world.block_size_m(), block);
  std::array<models::GroundPoint, kCount + 1> ground;
  models::sample_ground(world.terrain, block, points, ground);
  ground_here_m = ground[kCount].height_m;

  double sum = 0, weights = 0;
  for (int i = kSteps; i < kCount - kSteps; ++i) {
    const double weight = b_spline(2 * ((first + i) * step - t) / settings_.smoothing_s);
    if (weight == 0) continue;
    const auto around =
        std::span(ground).subspan(static_cast<std::size_t>(i - kSteps), 2 * kSteps + 1);
    sum += weight * std::ranges::max(around, {}, &models::GroundPoint::height_m).height_m;
    weights += weight;
  }
  return sum / weights;
}

std::uint64_t CameraPath::hash() const {
  std::uint64_t hash = 0;
  const auto add = [&hash](double value) {
    hash = core::combine(hash, std::bit_cast<std::uint64_t>(value));
  };
  add(settings_.origin_block.x);
  add(settings_.origin_block.z);
  add(settings_.smoothing_s);
  for (const PathPoint& point : points_) {
    for (const double value : {point.time_s, point.at_m.x, point.at_m.y, point.height_m,
                               point.pitch_deg, point.jump ? 1.0 : 0.0,
                               point.heading_deg ? 1.0
                               : point.look_at_m ? 2.0
                                                 : 0.0})
      add(value);
    if (point.heading_deg) add(*point.heading_deg);
    if (!point.heading_deg && point.look_at_m) {
      add(point.look_at_m->x);
      add(point.look_at_m->y);
    }
  }
  return hash;
}

core::CameraPose CameraPath::pose_at(double t, const World& world) const {
  const double time = std::isnan(t) ? points_.front().time_s
                                    : std::clamp(t, points_.front().time_s, duration_seconds());
  const Run& run = run_at(time);
  core::CameraPose pose;
  pose.position = core::normalised(
      {settings_.origin_block, {run.x.value(time), 0, run.z.value(time)}}, world.block_size_m());
  double ground_m = 0;
  const double smooth_m = smooth_ground_m(time, run, world, pose.position.block, ground_m);
  pose.position.local.y = std::max(smooth_m + run.height.value(time), ground_m + run.clearance_m);
  pose.yaw = run.yaw.value(time);
  pose.pitch = std::clamp(run.pitch.value(time), -std::numbers::pi / 2, std::numbers::pi / 2);
  return pose;
}

bool CameraPath::comes_within(double reach_m, const World& world) const {
  const double size_m = world.block_size_m();
  const auto beside_m = [size_m](std::int32_t origin, double at_m, std::int64_t blocks) {
    if (blocks == 0) return 0.0;  // endless
    const double place_m = origin * size_m + at_m;
    return std::max({0.0, -place_m, place_m - static_cast<double>(blocks) * size_m});
  };
  const core::BlockCoord origin = settings_.origin_block;
  return std::ranges::any_of(points_, [&](const PathPoint& point) {
    return std::hypot(beside_m(origin.x, point.at_m.x, world.blocks_x),
                      beside_m(origin.z, point.at_m.y, world.blocks_z)) <= reach_m;
  });
}

CameraPath recorded_path(const std::string& name, std::span<const TimedPose> poses,
                         const World& world) {
  PSYGEN_ASSERT(!poses.empty() && poses.size() <= kMaxRecordedPoses,
                "a path needs 1 to 10,000 points");
  const core::BlockCoord origin = poses.front().pose.position.block;
  std::vector<PathPoint> points;
  double heading = 0;
  for (const TimedPose& at : poses) {
    const core::WorldPosition& place = at.pose.position;
    const glm::dvec3 corner = core::offset_m(place.block, {origin, {}}, world.block_size_m());
    PathPoint point;
    point.time_s = at.time_s - poses.front().time_s;
    point.at_m = {corner.x + place.local.x, corner.z + place.local.z};
    point.height_m = kProbeHeight_m;
    heading = unwrapped(glm::degrees(at.pose.yaw), heading);
    point.heading_deg = std::clamp(heading, -kMaxHeading_deg, kMaxHeading_deg);
    point.pitch_deg = std::clamp(glm::degrees(at.pose.pitch), -kMaxPitch_deg, kMaxPitch_deg);
    point.jump = !points.empty() && glm::distance(point.at_m, points.back().at_m) >
                                        kLeap_m_s * (point.time_s - points.back().time_s);
    points.push_back(point);
  }
  const CameraPath::Settings settings{name, origin, kRecordedSmoothing_s};
  // Only the path knows the height of the ground to which its heights are added.
  const CameraPath probe(settings, points);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double ground_m =
        probe.pose_at(points[i].time_s, world).position.local.y - kProbeHeight_m;
    points[i].height_m = std::clamp(poses[i].pose.position.local.y - ground_m,
                                    CameraPath::kMinHeightM, CameraPath::kMaxHeightM);
  }
  return {settings, std::move(points)};
}

}  // namespace psygen::world
