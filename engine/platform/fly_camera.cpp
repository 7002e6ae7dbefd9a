#include "engine/platform/fly_camera.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace psygen::platform {
namespace {

double finite_or_zero(double value) {
  return std::isfinite(value) ? value : 0.0;
}

// 1, −1 or 0 for two opposite keys.
double axis(const InputState& input, Key positive, Key negative) {
  return (input.is_held(positive) ? 1.0 : 0.0) - (input.is_held(negative) ? 1.0 : 0.0);
}

// Moves `rate` exponentially towards `target` for dt and returns its integral over that time. Exact
// for a constant target: many short steps and one long step give the same result.
template <class Vector>
Vector integrate(Vector& rate, const Vector& target, double response_s, double dt_s) {
  const double decay = response_s > 0 ? std::exp(-dt_s / response_s) : 0.0;
  const Vector distance = target * dt_s + (rate - target) * (response_s * (1.0 - decay));
  rate = target + (rate - target) * decay;
  return distance;
}

}  // namespace

FlyCamera::FlyCamera(const FlyCameraSettings& settings)
    : settings_(settings),
      speed_m_s_(std::clamp(settings.speed_m_s, settings.min_speed_m_s, settings.max_speed_m_s)) {}

void FlyCamera::stop() {
  velocity_m_s_ = {};
  arrow_rad_s_ = {};
}

void FlyCamera::change_speed(double wheel) {
  const double steps = std::clamp(finite_or_zero(wheel), -100.0, 100.0);
  speed_m_s_ = std::clamp(speed_m_s_ * std::pow(settings_.wheel_factor, steps),
                          settings_.min_speed_m_s, settings_.max_speed_m_s);
}

void FlyCamera::turn(core::CameraPose& pose, const InputState& input, double dt_s) {
  const glm::dvec2 arrows{axis(input, Key::kRight, Key::kLeft), axis(input, Key::kUp, Key::kDown)};
  const glm::dvec2 turned =
      integrate(arrow_rad_s_, arrows * settings_.arrow_rad_s, settings_.response_s, dt_s);
  pose.yaw += turned.x + finite_or_zero(input.look_px.x) * settings_.mouse_rad_px;
  pose.pitch += turned.y - finite_or_zero(input.look_px.y) * settings_.mouse_rad_px;
  pose.pitch = std::clamp(pose.pitch, -settings_.max_pitch_rad, settings_.max_pitch_rad);
}

glm::dvec3 FlyCamera::wanted_velocity(const core::CameraPose& pose, const InputState& input) const {
  const glm::dvec3 forward(core::forward_of(pose));
  const glm::dvec3 right{std::cos(pose.yaw), 0.0, std::sin(pose.yaw)};
  const glm::dvec3 up{0.0, 1.0, 0.0};
  const glm::dvec3 direction = forward * axis(input, Key::kW, Key::kS) +
                               right * axis(input, Key::kD, Key::kA) +
                               up * axis(input, Key::kE, Key::kQ);
  const double length = glm::length(direction);
  if (length < 1e-6) return glm::dvec3(0.0);
  const double factor = (input.is_held(Key::kShift) ? settings_.shift_factor : 1.0) *
                        (input.is_held(Key::kControl) ? settings_.control_factor : 1.0);
  return direction * (speed_m_s_ * factor / length);
}

core::CameraPose FlyCamera::update(const core::CameraPose& pose, const InputState& input,
                                   double dt_s) {
  if (!core::is_valid(pose)) return pose;
  const double dt = std::clamp(finite_or_zero(dt_s), 0.0, settings_.max_step_s);
  core::CameraPose next = pose;
  change_speed(input.wheel);
  turn(next, input, dt);
  next.position.local +=
      integrate(velocity_m_s_, wanted_velocity(next, input), settings_.response_s, dt);
  if (core::is_valid(next)) return next;
  stop();
  return pose;
}

}  // namespace psygen::platform
