// Holds a frame time by how much it relieves frames of their work: more when they take too long,
// less, slowly, when there is time to spare. A little relief is fewer pixels, which acts at once;
// more is a larger error of levels of detail, which acts late (meshes must be synthesised first),
// so that it takes small steps and rests inside a band. At the start it measures some frames and
// then takes one step as large as they ask for; until frames reach the band it refines in larger
// steps than later. Where a wide view opens, as behind a hilltop, it does not wait until frames
// have been too long for a while: from how many triangles there are it knows what they will take
// (frame_line.hpp). Pure; no clock of its own.
#pragma once

#include <array>
#include <cstddef>

#include "engine/scene/quality/frame_line.hpp"

namespace psygen::scene {

// What the governor holds, and how far it may go.
struct GovernorSettings {
  double target_ms = 0;      // of a frame; 0: there is never any relief
  double max_relief = 4;     // >= 1
  double pixel_relief = 1;   // up to it relief is fewer pixels, beyond it fewer triangles
  double start_relief = 1;   // of the first frames
  double rest_share = 0.85;  // of the target: between it and the target nothing changes
};

// How much frames are relieved. Follows every observe().
class Governor {
 public:
  explicit Governor(const GovernorSettings& settings = {})
      : settings_(settings), relief_(settings.target_ms > 0 ? settings.start_relief : 1) {}

  // What the last frame took, without waiting for a display, and how many triangles it drew (0:
  // unknown). Times that are not positive are ignored, one frame counts for at most three targets.
  void observe(double frame_ms, double triangles = 0);

  // 1 … max_relief: 1 is none, pixels and triangles fall about in proportion to it.
  double relief() const { return relief_; }

 private:
  // Frames until the picture has followed the error: meshes, and fades of a fifth of a second.
  static constexpr std::size_t kLagFrames = 14;
  // The start: frames that still warm up, frames that are measured, and what their answer takes.
  static constexpr std::size_t kColdFrames = 2, kMeasuredFrames = 8;
  static constexpr std::size_t kStartFrames = kColdFrames + kMeasuredFrames + kLagFrames;

  void start(double frame_ms);
  void follow();
  void foresee(double triangles);

  GovernorSettings settings_;
  std::size_t frames_ = 0;  // observed, up to kStartFrames
  std::array<double, kMeasuredFrames> measured_ms_{};
  bool refining_ = true;  // since the start, and no frames have come to the band yet
  double smoothed_ms_ = 0;
  double relief_;
  FrameLine line_;
  std::array<double, kLagFrames> reliefs_{};  // of the last frames, a ring; 0: none yet
  std::size_t next_ = 0;                      // of the ring, the oldest
};

}  // namespace psygen::scene
