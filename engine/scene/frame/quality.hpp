// Resolution and allowed errors of a tick. One control loop decides both: from the time that the
// last frames took (Governor), and from the memory that meshes in view lacked (coarsening). Values;
// main thread only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace psygen::synthesis {
class MeshSupply;
}

namespace psygen::scene {

// Holds a frame time by adjusting the load reduction: it grows when frames take too long and
// shrinks slowly when there is time to spare. A small reduction lowers the resolution, which acts
// at once. A larger one raises the allowed error, which acts late, because meshes must be
// synthesised first; so it changes in small steps and rests inside a band. At the start the
// governor measures some frames and answers with one large step; until frames reach the band it
// refines in larger steps than later. When a wide view opens, as behind a hilltop, it predicts the
// frame time from the triangle count (FrameTimeFit) and reacts before frames become slow.
// Pure; has no clock: FrameTimeFit and Governor.

// A linear fit of frame time over triangle count in the recent past. Times are noisy and react late
// to a busy view; the triangle count is known at once.
class FrameTimeFit {
 public:
  // Adds a frame. The last two seconds at 60 Hz count.
  void observe(double frame_ms, double triangles);

  // Returns the triangle count of a frame with this time, at least 0. Infinity if triangles make no
  // difference, and before the first frame.
  double triangles(double frame_ms) const;

 private:
  double slope() const;  // milliseconds per triangle, at least 0

  double weight_ = 0;  // sum of the weights of all frames, up to 1
  double mean_ms_ = 0, mean_triangles_ = 0;
  double variance_ = 0, covariance_ = 0;  // of triangles; of times with triangles
};

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

struct Quality {
  Governor governor;
  double resolution = 1;    // render::FrameInput::resolution
  double error_pixels = 0;  // allowed screen-space error of nodes
  // Allowed error of individual models: the governor's factor counts by its square root, because
  // these models are near, in the focus of attention, and a small part of a frame's triangles.
  double model_error_pixels = 0;
  float coarsening = 1;  // >= 1: factor on both errors while the geometry budget is too small
  bool draft = false;    // Input::draft
  // Real time since when every frame has lacked meshes that can still be synthesised; +inf: the
  // last frame lacked none, or there was no frame.
  double awaiting_since_s = std::numeric_limits<double>::infinity();
  bool warned_budget = false;
};

// Shortages of the last tick. The cache and render systems write them; the quality system answers
// them in the next tick.
struct MemoryPressure {
  std::uint32_t refused_visible = 0;  // requests for meshes in view that found no memory
  std::uint32_t waiting = 0;          // requests whose memory is about to be free
  std::uint32_t awaited = 0;          // DrawCounts::awaited
  double seen_share = 0;              // fraction of the mesh memory that meshes in view take
  double at_s = 0;                    // the real clock at that time
};

struct FrameContext;
struct Input;
struct SceneSettings;

// System: decides how fine this frame is.
void quality_system(FrameContext frame, const Input& input, const MemoryPressure& pressure,
                    const synthesis::MeshSupply& supply, Quality& quality);
// Sets the resolution and the allowed errors from governor and coarsening.
void set_detail(const SceneSettings& settings, Quality& quality);
// The load reduction that the minimum resolution gives: 1 / min_resolution².
double resolution_reduction_of(const SceneSettings& settings);

}  // namespace psygen::scene
