// Predicts the camera's pose: constant velocity and constant turn rate, both smoothed over the last
// tenths of a second and bounded (paper, section 4.3: prefetching). A teleport restarts the
// prediction. Never changes the pose that is drawn. O(1). One thread at a time.
#pragma once

#include <glm/vec3.hpp>

#include "engine/core/camera.hpp"

namespace psygen::visibility {

// Without observations it predicts the default pose.
class CameraPredictor {
 public:
  // Limits of observed and predicted motion. A move faster than kMaxSpeed_m_s is a teleport.
  static constexpr double kMaxSpeed_m_s = 2000;
  static constexpr double kMaxTurnRate = 25;      // rad/s
  static constexpr double kMaxPrediction_s = 10;  // longer predictions are cut to this
  static constexpr double kSmoothing_s = 0.15;    // time constant: 63 % of a change is followed

  // The camera is at `pose` at `time_s`. Times increase from call to call; an earlier time restarts
  // the predictor. Poses that are not core::is_valid() and times that are not finite are ignored.
  void observe(double time_s, const core::CameraPose& pose, double block_size_m);

  // The pose `tau_s` seconds after the last observation, normalised. The turn is at most half a
  // circle and the pitch stays within ±90°. Returns the last observed pose for tau_s <= 0, and the
  // default pose without observations.
  core::CameraPose predict(double tau_s) const;

  // The smoothed velocity in m/s (+X, up, +Z) and turn rate to the right in rad/s.
  glm::dvec3 velocity_m_s() const { return velocity_; }
  double yaw_rate() const { return yaw_rate_; }

  // Forgets all observations.
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
