// Where the camera will be: constant velocity and constant turn rate, both smoothed over the last
// tenths of a second and bounded (paper, section 4.3: prefetching). Teleports start afresh. Not a
// filter for what is drawn: the pose itself is never changed. One thread at a time.
#pragma once

#include <glm/vec3.hpp>

#include "engine/core/camera.hpp"

namespace psygen::visibility {

class CameraPredictor {
 public:
  // Bounds of what is believed and predicted. A move faster than kMaxSpeed_m_s is a teleport.
  static constexpr double kMaxSpeed_m_s = 2000;
  static constexpr double kMaxTurnRate = 25;      // rad/s
  static constexpr double kMaxPrediction_s = 10;  // longer predictions are cut
  static constexpr double kSmoothing_s = 0.15;    // after this time 63 % of a change is believed

  // Where the camera is at `time_s`. Times grow from call to call; a call with an earlier time
  // starts afresh. Poses that are not core::is_valid() and times that are not finite are ignored.
  void observe(double time_s, const core::CameraPose& pose, double block_size_m);

  // The pose `tau_s` seconds after the last observation, normalised; the turn is at most half a
  // circle and the pitch stays within ±90°. tau_s <= 0 gives the last observed pose, without any
  // observation the default pose.
  core::CameraPose predict(double tau_s) const;

  glm::dvec3 velocity_m_s() const { return velocity_; }
  double yaw_rate() const { return yaw_rate_; }  // rad/s

  // Forgets everything.
  void reset() { *this = CameraPredictor(); }

 private:
  enum class State { kEmpty, kStanding, kMoving };  // nothing, one pose, two poses or more

  core::CameraPose pose_;
  glm::dvec3 velocity_{0.0};
  double yaw_rate_ = 0, pitch_rate_ = 0;
  double time_s_ = 0;
  double block_size_m_ = 1;
  State state_ = State::kEmpty;
};

}  // namespace psygen::visibility
