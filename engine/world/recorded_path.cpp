#include "engine/world/recorded_path.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "engine/core/assert.hpp"

namespace psygen::world {
namespace {

constexpr double kRecordedSmoothing_s = 0.1;  // the minimum, so poses stay near the recorded ones
constexpr double kLeap_m_s = 1900;            // path files allow at most 2000
constexpr double kMaxHeading_deg = 36'000, kMaxPitch_deg = 89;
constexpr double kProbeHeight_m = 1000;  // higher than any clearance

// `heading` within half a turn of the one before.
double unwrapped(double heading, double before) {
  return before + std::remainder(heading - before, 360.0);
}

}  // namespace

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
