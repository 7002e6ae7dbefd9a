// Samples of one quantity that arrive too often to store them all: thousands per second, each with
// its time. Stores all of them up to its capacity and a uniform choice beyond (reservoir sampling,
// Vitter 1985, algorithm R), deterministically. Memory is bounded; adding is O(1) and allocates
// only when the set doubles. One thread.
#pragma once

#include <cstdint>
#include <vector>

namespace psygen::telemetry {

// Samples of one run.
class SampleSet {
 public:
  // Stores at most `capacity` (at least 1) samples.
  explicit SampleSet(std::size_t capacity = std::size_t{1} << 17);

  // Adds a sample. Ignores one whose time or value is not finite.
  void add(double time_s, double value);
  // Number of added samples, stored or not.
  std::uint64_t added_count() const { return added_; }
  // Stored values with a time of at least `from_s`, in no particular order. If samples were
  // dropped, the largest value of all is still included. O(capacity).
  std::vector<double> values_since(double from_s) const;

 private:
  struct Sample {
    double time_s;
    double value;
  };

  std::size_t capacity_;
  std::uint64_t added_ = 0;
  Sample largest_{0, 0};
  std::vector<Sample> samples_;
};

}  // namespace psygen::telemetry
