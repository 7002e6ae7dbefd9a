// Registers kernel benchmarks for every instruction set of this CPU as "work/set". "work/reference"
// is the same work in plain double-precision code. main.cpp prints both in a table.
#pragma once

#include <benchmark/benchmark.h>

#include <functional>
#include <string>
#include <string_view>

#include "engine/models/kit/simd_targets.hpp"

namespace psygen::models::bench {

// Registers `body`, which runs with the set pinned; `adjust` sets the arguments of the benchmark.
// Returns true, for constants that register when the program starts.
inline bool for_each_target(
    const std::string& work, const std::function<void(benchmark::State&)>& body,
    const std::function<void(benchmark::internal::Benchmark*, bool best)>& adjust = {}) {
  const auto targets = simd_targets();
  for (const std::string_view target : targets) {
    const auto pinned = [body, target](benchmark::State& state) {
      pin_simd_target(target);
      body(state);
      unpin_simd_target();
    };
    auto* const registered =
        benchmark::RegisterBenchmark((work + "/" + std::string(target)).c_str(), pinned);
    if (adjust) adjust(registered, target == targets.front());
  }
  return true;
}

// Counters of the table: seconds for one of `count` equal things done in each iteration, and
// things per second.
inline void report_seconds_each(benchmark::State& state, double count) {
  state.counters["seconds_each"] =
      benchmark::Counter(count * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
inline void report_triangles(benchmark::State& state, double all) {
  state.counters["triangles_per_second"] = benchmark::Counter(all, benchmark::Counter::kIsRate);
}

}  // namespace psygen::models::bench
