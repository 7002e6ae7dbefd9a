// Measures the quality of the gate in `psygen compare` with the noise of real runs
// (docs/frame-tests.md):
//   psygen_bench_gate RUNS [COMPARISONS]
// RUNS is a folder with at least 32 runs of one program, named in chronological order. The two runs
// of a pair are consecutive, as in a comparison. Each comparison draws two batches of 8 pairs and
// the order within each pair, changes the frames of B as the line states, and computes the verdict.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numeric>
#include <random>

#include "engine/compare/compare.hpp"

namespace psygen::compare {
namespace {

using Random = std::mt19937_64;
using Change = std::function<void(RecordedRun&, Random&)>;
constexpr std::size_t kPairs = 8;

void scale(RecordedRun& run, double factor) {
  for (std::vector<double>* times : {&run.frame_ms, &run.cpu_ms})
    for (double& ms : *times)
      ms *= factor;
}

// Three frames in 200, the same in every run or different ones.
void double_frames(RecordedRun& run, Random random) {
  const std::size_t count = 3 * run.frame_ms.size() / 200;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t k = random() % run.frame_ms.size();
    run.frame_ms[k] *= 2;
    if (!run.cpu_ms.empty()) run.cpu_ms[k] *= 2;
  }
}

const std::pair<const char*, Change> kChanges[] = {
    {"nothing", [](RecordedRun&, Random&) {}},
    {"every frame +10 %", [](RecordedRun& run, Random&) { scale(run, 1.1); }},
    {"every frame -10 %", [](RecordedRun& run, Random&) { scale(run, 0.9); }},
    {"3 in 200 doubled, the same",
     [](RecordedRun& run, Random&) { double_frames(run, Random(5)); }},
    {"3 in 200 doubled, any",
     [](RecordedRun& run, Random& random) { double_frames(run, Random(random())); }},
    {"-20 %, 1 % more missing", [](RecordedRun& run, Random&) {
       scale(run, 0.8);
       run.missing_percent += 1;
     }}};

std::array<std::size_t, 4> verdicts(const std::vector<RecordedRun>& runs, const Change& change,
                                    std::size_t count) {
  Random random(1);
  std::vector<std::size_t> order(runs.size() / 2);  // of pairs
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::array<std::size_t, 4> counts{};
  for (std::size_t n = 0; n < count; ++n) {
    std::vector<RecordedRun> a, b;
    std::shuffle(order.begin(), order.end(), random);
    for (std::size_t i = 0; i < 2 * kPairs; ++i) {
      const std::size_t first = random() % 2;
      a.push_back(runs[2 * order[i] + first]);
      b.push_back(runs[2 * order[i] + 1 - first]);
      change(b.back(), random);
    }
    const auto result = compare(a, b);
    if (!result) {
      std::fprintf(stderr, "%s\n", result.error().message.c_str());
      std::exit(1);
    }
    ++counts[static_cast<std::size_t>(result->verdict)];
  }
  return counts;
}

}  // namespace
}  // namespace psygen::compare

int main(int argc, char** argv) {
  using namespace psygen::compare;
  if (argc < 2) {
    std::fprintf(stderr, "usage: psygen_bench_gate RUNS [COMPARISONS]\n");
    return 2;
  }
  const auto runs = read_runs(argv[1]);
  if (!runs || runs->size() < 4 * kPairs) {
    std::fprintf(stderr, "%s\n", runs ? "32 runs are needed" : runs.error().message.c_str());
    return 1;
  }
  const std::size_t count = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 100;
  std::printf("%zu runs of %zu frames, %zu comparisons a line\n%-28s %6s %6s %7s %12s\n",
              runs->size(), runs->front().frame_ms.size(), count, "B", "same", "worse", "better",
              "inconclusive");
  for (const auto& [name, change] : kChanges) {
    const auto counts = verdicts(*runs, change, count);
    std::printf("%-28s %6zu %6zu %7zu %12zu\n", name, counts[0], counts[1], counts[2], counts[3]);
  }
  return 0;
}
