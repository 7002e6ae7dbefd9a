#include "engine/telemetry/sample_set.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/assert.hpp"
#include "engine/core/hash.hpp"

namespace psygen::telemetry {

SampleSet::SampleSet(std::size_t capacity) : capacity_(capacity) {
  PSYGEN_CHECK(capacity > 0, "the capacity must be at least one sample");
}

void SampleSet::add(double time_s, double value) {
  if (!std::isfinite(time_s) || !std::isfinite(value)) return;
  if (added_ == 0 || value > largest_.value) largest_ = {time_s, value};
  if (samples_.size() < capacity_) {
    samples_.push_back({time_s, value});
  } else {
    const std::uint64_t slot = core::mix64(added_) % (added_ + 1);
    if (slot < capacity_) samples_[slot] = {time_s, value};
  }
  ++added_;
}

std::vector<double> SampleSet::values_since(double from_s) const {
  std::vector<double> values;
  for (const Sample& sample : samples_) {
    if (sample.time_s >= from_s) values.push_back(sample.value);
  }
  const bool largest_is_missing =
      added_ > samples_.size() && largest_.time_s >= from_s &&
      std::find(values.begin(), values.end(), largest_.value) == values.end();
  if (largest_is_missing) values.push_back(largest_.value);
  return values;
}

}  // namespace psygen::telemetry
