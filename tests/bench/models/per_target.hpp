// Benchmarks once per instruction set of this CPU: the first argument is its position in
// simd_targets(), and its name is the label.
#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "engine/models/simd_targets.hpp"

namespace psygen::models::bench {

// Pins the instruction set of a benchmark's first argument for as long as it lives.
class PinnedTarget {
 public:
  explicit PinnedTarget(benchmark::State& state) {
    const auto targets = simd_targets();
    const std::string_view name = targets[static_cast<std::size_t>(state.range(0))];
    pin_simd_target(name);
    state.SetLabel(std::string(name));
  }
  ~PinnedTarget() { unpin_simd_target(); }
  PinnedTarget(const PinnedTarget&) = delete;
  PinnedTarget& operator=(const PinnedTarget&) = delete;
};

// For BENCHMARK(...)->Apply: every instruction set.
inline void each_target(benchmark::internal::Benchmark* b) {
  b->ArgName("target");
  for (std::size_t t = 0; t < simd_targets().size(); ++t)
    b->Arg(static_cast<std::int64_t>(t));
}

// Every instruction set with every value from `first` to `last` in steps.
inline void each_target_with(benchmark::internal::Benchmark* b, const std::string& name, int first,
                             int last, int step) {
  b->ArgNames({"target", name});
  for (std::size_t t = 0; t < simd_targets().size(); ++t) {
    for (int value = first; value <= last; value += step)
      b->Args({static_cast<std::int64_t>(t), value});
  }
}

}  // namespace psygen::models::bench
