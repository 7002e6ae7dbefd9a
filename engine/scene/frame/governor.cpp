#include "engine/scene/frame/governor.hpp"

#include <algorithm>

namespace psygen::scene {
namespace {

constexpr double kSmoothing = 0.1;  // weight of the newest frame; the first frame counts fully
// Steps for a frame time that is off by kFullStepAt: at 60 Hz the load reduction doubles in a
// second and halves in four, or in one at the start. Frames that take far too long get up to
// kMaxSteps steps.
constexpr double kStepUp = 0.012, kStepDown = 0.003, kStartStepDown = 0.012;
constexpr double kFullStepAt = 0.25;
constexpr double kMaxSteps = 3;
// With too many triangles in view, the load reduction also grows by at most this fraction per
// frame.
constexpr double kJump = 0.12;

}  // namespace

void Governor::observe(double frame_ms, double triangles) {
  const double target_ms = settings_.target_ms;
  if (!(target_ms > 0) || !(frame_ms > 0)) return;
  const double counted_ms = std::min(frame_ms, 3 * target_ms);
  if (frames_ < kStartFrames) return start(counted_ms);
  smoothed_ms_ += (counted_ms - smoothed_ms_) * (smoothed_ms_ > 0 ? kSmoothing : 1);
  const double before = reduction_;
  follow();
  if (triangles > 0) {
    line_.observe(counted_ms, triangles);
    foresee(triangles);
  }
  reduction_ = std::clamp(reduction_, 1.0, settings_.max_reduction);
  reductions_[next_] = before;
  next_ = (next_ + 1) % kLagFrames;
}

// Frame times fall at most in proportion to the load reduction, because part of a frame is
// constant. So the one step never refines too far, and the steps of follow() do the rest.
void Governor::start(double frame_ms) {
  const std::size_t frame = frames_++;
  if (frame < kColdFrames || frame >= kColdFrames + kMeasuredFrames) return;
  measured_ms_[frame - kColdFrames] = frame_ms;
  if (frame + 1 < kColdFrames + kMeasuredFrames) return;
  const auto middle = measured_ms_.begin() + kMeasuredFrames / 2;
  std::nth_element(measured_ms_.begin(), middle, measured_ms_.end());
  const double share = *middle / settings_.target_ms;
  if (share > 1 || share < settings_.rest_share) reduction_ *= share / settings_.rest_share;
  reduction_ = std::clamp(reduction_, 1.0, settings_.max_reduction);
  refining_ = share < settings_.rest_share;
}

// Adjusts the load reduction to the times of the last frames.
void Governor::follow() {
  const double target_ms = settings_.target_ms;
  const double over = smoothed_ms_ / target_ms - 1;
  const double under = settings_.rest_share - smoothed_ms_ / target_ms;
  if (under <= 0) refining_ = false;
  if (over > 0) {
    reduction_ *= 1 + kStepUp * std::min(over / kFullStepAt, kMaxSteps);
  } else if (under > 0) {
    reduction_ *= 1 - (refining_ ? kStartStepDown : kStepDown) * std::min(under / kFullStepAt, 1.0);
  }
}

// Adjusts to the triangles of the last frame. A lower resolution acts at once. Triangle counts
// follow the error of some frames ago, and fall about in proportion as the error grows.
void Governor::foresee(double triangles) {
  const double allowed = line_.triangles(settings_.target_ms), lagging = reductions_[next_];
  if (!(lagging > 0) || triangles <= allowed) return;
  const double pixels = settings_.resolution_reduction;
  const double enough = reduction_ < pixels ? std::min(pixels, reduction_ * triangles / allowed)
                                            : std::max(lagging, pixels) * triangles / allowed;
  if (enough > reduction_) reduction_ = std::min(enough, reduction_ * (1 + kJump));
}

}  // namespace psygen::scene
