// A linear fit of frame time over triangle count in the recent past. Times are noisy and react late
// to a busy view; the triangle count is known at once. Pure; has no clock.
#pragma once

namespace psygen::scene {

// The fit over the frames observed so far.
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

}  // namespace psygen::scene
