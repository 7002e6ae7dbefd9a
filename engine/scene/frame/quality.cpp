#include "engine/scene/frame/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/core/log.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/settings.hpp"
#include "engine/synthesis/mesh_supply.hpp"

namespace psygen::scene {
namespace {

// Factors on coarsening per tick: quickly up while memory is short, slowly down when it suffices.
constexpr float kUp = 1.15F, kDown = 0.99F, kCoarsest = 64.0F;

std::string scarce_memory(const synthesis::CacheStats& stats) {
  const std::uint64_t capacity_mib = stats.capacity_bytes >> 20;
  if (capacity_mib >= stats.budget_bytes >> 20) return "the geometry budget";
  return fmt::format("the memory that the system has for geometry ({} MiB)", capacity_mib);
}

void warn_once(const SceneSettings& settings, const synthesis::CacheStats& stats,
               Quality& quality) {
  if (std::exchange(quality.warned_budget, true)) return;
  core::log_warning(fmt::format("{} is too small for this view{}", scarce_memory(stats),
                                settings.levels_of_detail
                                    ? "; drawing coarser levels"
                                    : " at full detail; some of it is missing"));
}

void adapt_to_memory(const FrameContext& frame, const MemoryPressure& pressure,
                     const synthesis::MeshSupply& supply, Quality& quality) {
  // Finer meshes in view need free memory, and so do meshes around the view. Lazy evaluation has no
  // next tick to catch up in, and the last two frames, still in flight, may hold their memory:
  // three frames must fit.
  const double roomy = frame.rules.wait ? 0.28 : 0.5;
  const bool too_late = frame.rules.wait && (pressure.waiting > 0 || pressure.seen_share > 1.0 / 3);
  if (pressure.refused_visible > 0 || too_late) {
    quality.coarsening = std::min(quality.coarsening * kUp, kCoarsest);
    warn_once(frame.settings, supply.stats(), quality);
  } else if (pressure.seen_share < roomy) {
    quality.coarsening = std::max(quality.coarsening * kDown, 1.0F);
  }
}

// The fraction of width and height that leaves at most 1 / load_reduction of the pixels. Changes in
// steps: one step is not visible, and most frames keep the scale of the frame before.
double resolution_for(double load_reduction, double minimum) {
  constexpr double kSteps = 20, kBeyondRounding = 1e-9;
  return std::max(std::floor(kSteps / std::sqrt(load_reduction) + kBeyondRounding) / kSteps,
                  minimum);
}

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

constexpr double kNewest = 1.0 / 120;  // weight of the newest frame
// If triangle counts have hardly changed, the slope cannot be measured and counts as zero. At this
// spread of the counts, relative to their mean, half of the measured slope counts.
constexpr double kTrustedSpread = 0.1;

}  // namespace

double resolution_reduction_of(const SceneSettings& settings) {
  return 1 / (settings.min_resolution * settings.min_resolution);
}

void set_detail(const SceneSettings& settings, Quality& quality) {
  const double reduction = quality.governor.load_reduction();
  const double by_resolution = resolution_reduction_of(settings);
  quality.resolution = resolution_for(std::min(reduction, by_resolution), settings.min_resolution);
  const double factor = std::max(reduction / by_resolution, 1.0);
  const double unhurried = settings.max_error_pixels * double{quality.coarsening};
  quality.error_pixels = unhurried * factor;
  quality.model_error_pixels = unhurried * std::sqrt(factor);
}

void quality_system(FrameContext frame, const Input& input, const MemoryPressure& pressure,
                    const synthesis::MeshSupply& supply, Quality& quality) {
  adapt_to_memory(frame, pressure, supply, quality);
  quality.awaiting_since_s = pressure.awaited > 0
                                 ? std::min(quality.awaiting_since_s, pressure.at_s)
                                 : std::numeric_limits<double>::infinity();
  quality.governor.observe(input.frame_ms, input.frame_triangles);
  quality.draft = input.draft;
  set_detail(frame.settings, quality);
}

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

void FrameTimeFit::observe(double frame_ms, double triangles) {
  weight_ += (1 - weight_) * kNewest;
  const double share = kNewest / weight_;  // the first frame counts fully
  const double ms = frame_ms - mean_ms_, more = triangles - mean_triangles_;
  mean_ms_ += share * ms;
  mean_triangles_ += share * more;
  variance_ += share * ((1 - share) * more * more - variance_);
  covariance_ += share * ((1 - share) * ms * more - covariance_);
}

double FrameTimeFit::slope() const {
  if (!(mean_triangles_ > 0)) return 0;
  const double doubt = kTrustedSpread * mean_triangles_;
  return std::max(covariance_ / (variance_ + doubt * doubt), 0.0);
}

double FrameTimeFit::triangles(double frame_ms) const {
  const double each_ms = slope();
  if (!(each_ms > 0)) return std::numeric_limits<double>::infinity();
  return std::max(mean_triangles_ + (frame_ms - mean_ms_) / each_ms, 0.0);
}

}  // namespace psygen::scene
