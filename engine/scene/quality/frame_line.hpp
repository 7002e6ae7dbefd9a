// How long a frame takes over the triangles that it draws: a line through the recent past. Times
// are noisy and tell of a busy picture only once it has been drawn for a while; how many triangles
// it has is known at once. Pure; no clock of its own.
#pragma once

namespace psygen::scene {

// The fit over the frames observed so far.
class FrameLine {
 public:
  // One frame; the last ones of about two seconds at 60 Hz count.
  void observe(double frame_ms, double triangles);

  // How many a frame of this time draws; at least 0. Infinity where they make no difference, and
  // before the first frame.
  double triangles(double frame_ms) const;

 private:
  double slope() const;  // milliseconds a triangle, at least 0

  double weight_ = 0;  // of all frames together, up to 1
  double mean_ms_ = 0, mean_triangles_ = 0;
  double variance_ = 0, covariance_ = 0;  // of triangles; of times with them
};

}  // namespace psygen::scene
