#include "editor/view/view_camera.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace psygen::editor {
namespace {

constexpr double kTurnRadPx = 0.005;       // around the pivot
constexpr double kMaxPitch = 1.55;         // slightly less than vertical
constexpr double kApproachPerStep = 0.85;  // factor of the distance
constexpr double kNearestM = 0.5;
constexpr double kWheelM = 4;  // per step without a pivot

}  // namespace

void ViewCamera::set_pose(const core::CameraPose& pose) {
  if (!core::is_valid(pose)) return;
  pose_ = pose;
  pose_.position = core::normalised(pose_.position, block_m_);
  fly_.stop();
}

bool ViewCamera::update(const platform::InputState& input, double dt_s) {
  const core::CameraPose before = pose_;
  platform::InputState flown = input;
  flown.wheel = input.held.any() ? input.wheel : 0;  // changes the speed while flying
  pose_ = fly_.update(pose_, flown, dt_s);
  if (input.is_held(platform::MouseButton::kMiddle) ||
      (turntable_ && input.is_held(platform::MouseButton::kLeft)))
    orbit(input.move_px.x, input.move_px.y);
  if (input.wheel != 0 && !input.held.any()) approach(input.wheel);
  if (!core::is_valid(pose_)) pose_ = before;
  pose_.position = core::normalised(pose_.position, block_m_);
  return pose_.position.block != before.position.block ||
         pose_.position.local != before.position.local || pose_.yaw != before.yaw ||
         pose_.pitch != before.pitch;
}

double ViewCamera::pivot_distance_m() const {
  return glm::length(core::offset_m(pivot_->block, pose_.position, block_m_) + pivot_->local);
}

void ViewCamera::orbit(double right_px, double down_px) {
  const double distance_m = pivot_ ? pivot_distance_m() : 0;
  pose_.yaw += right_px * kTurnRadPx;
  pose_.pitch = std::clamp(pose_.pitch - down_px * kTurnRadPx, -kMaxPitch, kMaxPitch);
  if (pivot_) focus(distance_m);
}

void ViewCamera::approach(double wheel) {
  if (!pivot_) {
    pose_.position.local += glm::dvec3(core::forward_of(pose_)) * wheel * kWheelM;
    return;
  }
  const glm::dvec3 to = core::offset_m(pivot_->block, pose_.position, block_m_) + pivot_->local;
  const double distance_m = glm::length(to);
  if (distance_m < kNearestM && wheel > 0) return;
  pose_.position.local += to * (1 - std::pow(kApproachPerStep, wheel));
}

void ViewCamera::focus(double distance_m) {
  if (!pivot_) return;
  pose_.position = *pivot_;
  pose_.position.local -= glm::dvec3(core::forward_of(pose_)) * distance_m;
  fly_.stop();
}

}  // namespace psygen::editor
