// Holds a frame time by adjusting the load reduction: it grows when frames take too long and
// shrinks slowly when there is time to spare. A small reduction lowers the resolution, which acts
// at once. A larger one raises the allowed error, which acts late, because meshes must be
// synthesised first; so it changes in small steps and rests inside a band. At the start the
// governor measures some frames and answers with one large step; until frames reach the band it
// refines in larger steps than later. When a wide view opens, as behind a hilltop, it predicts the
// frame time from the triangle count (frame_time_fit.hpp) and reacts before frames become slow.
// Pure; has no clock.
#pragma once

#include <array>
#include <cstddef>

#include "engine/scene/frame/frame_time_fit.hpp"

namespace psygen::scene {

// The target, and the limits of the load reduction.
struct GovernorSettings {
  double target_ms = 0;             // frame time; 0: never reduces
  double max_reduction = 4;         // >= 1
  double resolution_reduction = 1;  // up to it the resolution falls, beyond it the triangle count
  double start_reduction = 1;       // of the first frames
  double rest_share = 0.85;  // fraction of the target: nothing changes between it and the target
};

// The load reduction after each observe().
class Governor {
 public:
  explicit Governor(const GovernorSettings& settings = {})
      : settings_(settings), reduction_(settings.target_ms > 0 ? settings.start_reduction : 1) {}

  // Observes the time of the last frame without waits for a display, and its triangle count (0:
  // unknown). Ignores times that are not positive; counts a frame as at most three targets.
  void observe(double frame_ms, double triangles = 0);

  // The factor in 1 … max_reduction by which pixels and triangles are reduced, about in proportion;
  // 1: not at all.
  double load_reduction() const { return reduction_; }

 private:
  // Frames until the frame reflects a new error: synthesis, and fades of a fifth of a second.
  static constexpr std::size_t kLagFrames = 14;
  // The start: warm-up frames, measured frames, and the frames until their answer is visible.
  static constexpr std::size_t kColdFrames = 2, kMeasuredFrames = 8;
  static constexpr std::size_t kStartFrames = kColdFrames + kMeasuredFrames + kLagFrames;

  void start(double frame_ms);
  void follow();
  void foresee(double triangles);

  GovernorSettings settings_;
  std::size_t frames_ = 0;  // observed, up to kStartFrames
  std::array<double, kMeasuredFrames> measured_ms_{};
  bool refining_ = true;  // since the start, until frames reach the band
  double smoothed_ms_ = 0;
  double reduction_;
  FrameTimeFit line_;
  std::array<double, kLagFrames> reductions_{};  // of the last frames, a ring; 0: none yet
  std::size_t next_ = 0;                         // the oldest entry of the ring
};

}  // namespace psygen::scene
