// A flying camera: WASD along and across the view, E and Q up and down, mouse or arrow keys to
// turn, wheel for the speed, shift faster, control slower. Speeds follow the keys smoothly, and
// equally at every frame rate. The result depends only on pose, input and time. Knows no window and
// no world: it flies through mountains. NaN and infinities never reach the pose. One thread at a
// time.
#pragma once

#include <glm/vec3.hpp>

#include "engine/core/camera.hpp"
#include "engine/platform/input.hpp"

namespace psygen::platform {

// Speeds and limits of the camera.
struct FlyCameraSettings {
  double speed_m_s = 20.0;  // without shift and control
  double min_speed_m_s = 0.5;
  double max_speed_m_s = 2000.0;
  double wheel_factor = 1.25;  // factor on the speed per wheel step
  double shift_factor = 5.0;
  double control_factor = 0.2;
  double response_s = 0.12;      // time to 63 % of a new speed
  double mouse_rad_px = 0.0025;  // turn per pixel
  double arrow_rad_s = 1.4;      // turn by arrow keys
  double max_pitch_rad = 1.55;   // slightly less than straight up or down
  double max_step_s = 0.25;      // longer frames count as this long
};

// Keeps the current velocity; callers keep the pose.
class FlyCamera {
 public:
  // Starts at rest. The speed is clamped to the settings' range.
  explicit FlyCamera(const FlyCameraSettings& settings = {});

  // The pose `dt_s` seconds after `pose`. The position is not normalised to its block. Returns an
  // invalid pose unchanged. If the flight would make a valid pose invalid, returns it unchanged and
  // stops the camera.
  core::CameraPose update(const core::CameraPose& pose, const InputState& input, double dt_s);

  // The speed in metres per second, without shift and control.
  double speed_m_s() const { return speed_m_s_; }
  // The current velocity in metres per second: +X, up, +Z. For prediction.
  glm::dvec3 velocity_m_s() const { return velocity_m_s_; }
  // Stops moving and turning at once, for teleports.
  void stop();

 private:
  void turn(core::CameraPose& pose, const InputState& input, double dt_s);
  void change_speed(double wheel);
  glm::dvec3 wanted_velocity(const core::CameraPose& pose, const InputState& input) const;

  FlyCameraSettings settings_;
  double speed_m_s_;
  glm::dvec3 velocity_m_s_{0.0};
  glm::dvec2 arrow_rad_s_{0.0};  // current turn by arrow keys: right, up
};

}  // namespace psygen::platform
