// The camera of the view: flies with keys and the right button, and orbits a pivot with the middle
// button. Knows no window: input is a value. Main thread.
#pragma once

#include <optional>

#include "engine/core/camera.hpp"
#include "engine/platform/fly_camera.hpp"

namespace psygen::editor {

class ViewCamera {
 public:
  const core::CameraPose& pose() const { return pose_; }
  // The side of a block in metres, above 0.
  void set_block_size(double block_m) { block_m_ = block_m; }
  // Jumps to a pose. Ignores invalid poses.
  void set_pose(const core::CameraPose& pose);
  // Advances by `dt_s` seconds. The right button turns the view, the middle one orbits the pivot
  // (or turns in place without one), the wheel moves towards the pivot, or changes the speed while
  // a key is held. Returns true if the pose changed.
  bool update(const platform::InputState& input, double dt_s);

  // The point that the middle button orbits; nullopt: the camera turns in place.
  void set_pivot(std::optional<core::WorldPosition> pivot) { pivot_ = pivot; }
  const std::optional<core::WorldPosition>& pivot() const { return pivot_; }
  // Looks at the pivot from this distance in metres, in the present direction. Does nothing without
  // a pivot.
  void focus(double distance_m);
  // Lets the left button orbit the pivot too.
  void set_turntable(bool on) { turntable_ = on; }
  double speed_m_s() const { return fly_.speed_m_s(); }

 private:
  double pivot_distance_m() const;
  void orbit(double right_px, double down_px);
  void approach(double wheel);

  platform::FlyCamera fly_;
  core::CameraPose pose_;
  double block_m_ = 1;
  bool turntable_ = false;
  std::optional<core::WorldPosition> pivot_;
};

}  // namespace psygen::editor
