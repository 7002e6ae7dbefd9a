#include "engine/scene/frame/frame_time_fit.hpp"

#include <algorithm>
#include <limits>

namespace psygen::scene {
namespace {

constexpr double kNewest = 1.0 / 120;  // weight of the newest frame
// If triangle counts have hardly changed, the slope cannot be measured and counts as zero. At this
// spread of the counts, relative to their mean, half of the measured slope counts.
constexpr double kTrustedSpread = 0.1;

}  // namespace

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
