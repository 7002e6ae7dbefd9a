#include "engine/telemetry/reference_load.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <memory>
#include <new>
#include <thread>
#include <vector>

#include "engine/core/clock.hpp"
#include "engine/core/headroom.hpp"
#include "engine/core/processors.hpp"

namespace psygen::telemetry {
namespace {

// The result keeps the compiler from leaving the work out.
std::uint64_t arithmetic(std::uint64_t steps) {
  std::uint64_t x = 1, word = 88172645463325252ull;
  double value = 0.5;
  for (std::uint64_t i = 0; i < steps; ++i) {
    x = 6364136223846793005ull * x + 1442695040888963407ull;
    word ^= word << 13;
    word ^= word >> 7;
    word ^= word << 17;
    value = value * 0.999 + 0.25;
    value = value * 0.998 + 0.125;
  }
  return x ^ word ^ static_cast<std::uint64_t>(value);
}

template <class Work>
LoadTimes time_of(const Work& work) {
  const double start_s = core::monotonic_seconds(), cpu_start_s = core::thread_cpu_seconds();
  volatile std::uint64_t result = work();
  (void)result;
  return {core::monotonic_seconds() - start_s, core::thread_cpu_seconds() - cpu_start_s};
}

LoadTimes missing(const char* reason) {
  return {Figure::missing(reason), Figure::missing(reason)};
}

LoadTimes stream(const ReferenceWork& work) {
  const auto there = std::unique_ptr<std::byte[]>(new (std::nothrow) std::byte[work.copy_bytes]);
  const auto back = std::unique_ptr<std::byte[]>(new (std::nothrow) std::byte[work.copy_bytes]);
  if (!there || !back) return missing("memory ran out");
  std::memset(there.get(), 1, work.copy_bytes);  // the system gives the pages now
  std::memset(back.get(), 2, work.copy_bytes);
  return time_of([&] {
    std::uint64_t sum = 0;
    for (int i = 0; i < work.copies; ++i) {
      there[0] = static_cast<std::byte>(i);
      std::memcpy(back.get(), there.get(), work.copy_bytes);
      std::memcpy(there.get(), back.get(), work.copy_bytes);
      sum += static_cast<std::uint64_t>(there[work.copy_bytes - 1]);
    }
    return sum;
  });
}

LoadTimes pair(const ReferenceWork& work, std::uint64_t threads) {
  std::vector<double> cpu_s(threads, 0.0);
  std::vector<std::thread> others;
  std::atomic<std::uint64_t> result{0};
  const double start_s = core::monotonic_seconds();
  const auto part = [&](std::uint64_t i) {
    const double cpu_start_s = core::thread_cpu_seconds();
    result += arithmetic(work.steps);
    cpu_s[i] = core::thread_cpu_seconds() - cpu_start_s;
  };
  bool all = true;
  for (std::uint64_t i = 1; i < threads && all; ++i) {
    auto thread = core::start_thread([&part, i] { part(i); });
    all = thread.has_value();
    if (all) others.push_back(std::move(*thread));
  }
  if (all) part(0);
  for (std::thread& thread : others)
    thread.join();
  if (!all) return missing("the system refused a thread");
  double sum_s = 0;
  for (const double each : cpu_s)
    sum_s += each;
  return {core::monotonic_seconds() - start_s, sum_s};
}

Figure mean_of(const Figure& a, const Figure& b) {
  return !a.has_value() ? a : !b.has_value() ? b : Figure((*a + *b) / 2);
}

LoadTimes mean_of(const LoadTimes& a, const LoadTimes& b) {
  return {mean_of(a.wall_s, b.wall_s), mean_of(a.cpu_s, b.cpu_s)};
}

}  // namespace

ReferenceLoad measure_reference_load(const ReferenceWork& work) {
  const std::uint64_t threads = work.threads > 0 ? work.threads : core::usable_processors();
  ReferenceLoad load;
  load.arith = time_of([&work] { return arithmetic(work.steps); });
  load.stream = stream(work);
  load.pair = pair(work, threads);
  return load;
}

ReferenceLoad mean_of(const ReferenceLoad& before, const ReferenceLoad& after) {
  return {mean_of(before.arith, after.arith), mean_of(before.stream, after.stream),
          mean_of(before.pair, after.pair)};
}

Figure cpu_seconds_of(const ReferenceLoad& load) {
  double sum_s = 0;
  for (const LoadTimes* part : {&load.arith, &load.stream, &load.pair}) {
    if (!part->cpu_s.has_value()) return part->cpu_s;
    sum_s += *part->cpu_s;
  }
  return sum_s;
}

}  // namespace psygen::telemetry
