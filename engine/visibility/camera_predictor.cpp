#include "engine/visibility/camera_predictor.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "engine/core/assert.hpp"

namespace psygen::visibility {
namespace {
constexpr double kPi = std::numbers::pi;

// Returns the turn in [−π, π] from one angle to the other.
double turn_between(double from, double to) {
  return std::remainder(to - from, 2 * kPi);
}
}  // namespace

void CameraPredictor::observe(double time_s, const core::CameraPose& pose, double block_size_m) {
  PSYGEN_ASSERT(block_size_m > 0, "the block size must be positive");
  if (!core::is_valid(pose) || !std::isfinite(time_s)) return;
  const CameraPredictor before = *this;
  *this = CameraPredictor();
  pose_ = pose;
  time_s_ = time_s;
  block_size_m_ = block_size_m;
  state_ = State::kStanding;

  const double dt = time_s - before.time_s_;
  if (before.state_ == State::kEmpty || dt < 0) return;
  if (dt == 0) {
    velocity_ = before.velocity_;
    yaw_rate_ = before.yaw_rate_;
    pitch_rate_ = before.pitch_rate_;
    state_ = before.state_;
    return;
  }
  const glm::dvec3 move = core::offset_m(pose.position.block, before.pose_.position, block_size_m) +
                          pose.position.local;
  if (glm::length(move) > kMaxSpeed_m_s * dt) return;

  const double share = before.state_ == State::kStanding ? 1 : 1 - std::exp(-dt / kSmoothing_s);
  const auto bounded = [](double rate) { return std::clamp(rate, -kMaxTurnRate, kMaxTurnRate); };
  velocity_ = before.velocity_ + (move / dt - before.velocity_) * share;
  yaw_rate_ =
      std::lerp(before.yaw_rate_, bounded(turn_between(before.pose_.yaw, pose.yaw) / dt), share);
  pitch_rate_ =
      std::lerp(before.pitch_rate_, bounded((pose.pitch - before.pose_.pitch) / dt), share);
  state_ = State::kMoving;
}

core::CameraPose CameraPredictor::predict(double tau_s) const {
  if (!(tau_s > 0)) return pose_;
  const double tau = std::min(tau_s, kMaxPrediction_s);
  core::CameraPose pose = pose_;
  pose.position.local += velocity_ * tau;
  pose.position = core::normalised(pose.position, block_size_m_);
  pose.yaw += std::clamp(yaw_rate_ * tau, -kPi, kPi);
  pose.pitch = std::clamp(pose.pitch + pitch_rate_ * tau, -kPi / 2, kPi / 2);
  return pose;
}

}  // namespace psygen::visibility
