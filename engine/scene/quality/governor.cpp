#include "engine/scene/quality/governor.hpp"

#include <algorithm>

namespace psygen::scene {
namespace {

constexpr double kSmoothing = 0.1;  // share of the newest frame; the first counts wholly
// Steps of a frame whose time is off by kFullStepAt: at 60 Hz the relief doubles in a second and
// halves in four, at the start in one. Frames that take far too long are answered by up to
// kMaxSteps of them.
constexpr double kStepUp = 0.012, kStepDown = 0.003, kStartStepDown = 0.012;
constexpr double kFullStepAt = 0.25;
constexpr double kMaxSteps = 3;
// With too many triangles in view, the relief also grows by at most this share in a frame.
constexpr double kJump = 0.12;

}  // namespace

void Governor::observe(double frame_ms, double triangles) {
  const double target_ms = settings_.target_ms;
  if (!(target_ms > 0) || !(frame_ms > 0)) return;
  const double counted_ms = std::min(frame_ms, 3 * target_ms);
  if (frames_ < kStartFrames) return start(counted_ms);
  smoothed_ms_ += (counted_ms - smoothed_ms_) * (smoothed_ms_ > 0 ? kSmoothing : 1);
  const double before = relief_;
  follow();
  if (triangles > 0) {
    line_.observe(counted_ms, triangles);
    foresee(triangles);
  }
  relief_ = std::clamp(relief_, 1.0, settings_.max_relief);
  reliefs_[next_] = before;
  next_ = (next_ + 1) % kLagFrames;
}

// Frame times fall at most in proportion to the relief: part of a frame is always there. So the one
// step does not refine too far, and steps of follow() do the rest.
void Governor::start(double frame_ms) {
  const std::size_t frame = frames_++;
  if (frame < kColdFrames || frame >= kColdFrames + kMeasuredFrames) return;
  measured_ms_[frame - kColdFrames] = frame_ms;
  if (frame + 1 < kColdFrames + kMeasuredFrames) return;
  const auto middle = measured_ms_.begin() + kMeasuredFrames / 2;
  std::nth_element(measured_ms_.begin(), middle, measured_ms_.end());
  const double share = *middle / settings_.target_ms;
  if (share > 1 || share < settings_.rest_share) relief_ *= share / settings_.rest_share;
  relief_ = std::clamp(relief_, 1.0, settings_.max_relief);
  refining_ = share < settings_.rest_share;
}

// Changes the relief by the times of the last frames.
void Governor::follow() {
  const double target_ms = settings_.target_ms;
  const double over = smoothed_ms_ / target_ms - 1;
  const double under = settings_.rest_share - smoothed_ms_ / target_ms;
  if (under <= 0) refining_ = false;
  if (over > 0) {
    relief_ *= 1 + kStepUp * std::min(over / kFullStepAt, kMaxSteps);
  } else if (under > 0) {
    relief_ *= 1 - (refining_ ? kStartStepDown : kStepDown) * std::min(under / kFullStepAt, 1.0);
  }
}

// By the triangles of the last frame. Fewer pixels act at once. Triangles are those of the error
// some frames ago and become fewer as the error grows, about in proportion.
void Governor::foresee(double triangles) {
  const double allowed = line_.triangles(settings_.target_ms), lagging = reliefs_[next_];
  if (!(lagging > 0) || triangles <= allowed) return;
  const double pixels = settings_.pixel_relief;
  const double enough = relief_ < pixels ? std::min(pixels, relief_ * triangles / allowed)
                                         : std::max(lagging, pixels) * triangles / allowed;
  if (enough > relief_) relief_ = std::min(enough, relief_ * (1 + kJump));
}

}  // namespace psygen::scene
