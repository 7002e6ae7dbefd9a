// Time of erosion for a sample of a block, of coarser nodes, and of a single place, on every
// instruction set of this CPU. The guide is a plane, so that its own time does not count.
#include <benchmark/benchmark.h>

#include <numeric>
#include <vector>

#include "engine/models/ground/erosion.hpp"
#include "tests/bench/synthesis/per_target.hpp"

namespace psygen::models {
namespace {

struct Plane final : ErosionGuide {
  void heights(std::span<const std::int64_t> columns, std::span<const std::int64_t> rows, double,
               std::span<float> values, std::size_t stride) const override {
    for (std::size_t r = 0; r < rows.size(); ++r) {
      for (std::size_t c = 0; c < columns.size(); ++c)
        values[r * stride + c] = static_cast<float>((columns[c] + 2 * rows[r]) & 1023);
    }
  }
};

// The arguments are the samples along a side and the detail.
void erosion(benchmark::State& state) {
  const auto side = static_cast<std::size_t>(state.range(0));
  const int detail = static_cast<int>(state.range(1));
  Erosion usual;
  usual.strength = 0.5;
  const ErosionFilter filter(usual, {.seed = 1, .highest = 1e4F}, detail);
  const std::int64_t step = detail == 0 ? 1 : std::int64_t{1} << (detail - 1);
  std::vector<std::int64_t> columns(side), rows(side);
  std::vector<float> values(side * side, 500.0F);
  std::int64_t block = 0;
  for (auto _ : state) {
    for (std::size_t i = 0; i < side; ++i) {
      columns[i] = (63 * block + static_cast<std::int64_t>(i)) * step;
      rows[i] = (17 * block + static_cast<std::int64_t>(i)) * step;
    }
    ++block;
    filter.apply(Plane(), columns, rows, values, side);
    benchmark::DoNotOptimize(values.data());
  }
  bench::report_seconds_each(state, static_cast<double>(side * side));
}

const bool kRegistered = bench::for_each_target("erosion", erosion, [](auto* b, bool) {
  b->ArgNames({"side", "detail"})
      ->Args({64, 0})
      ->Args({64, 2})
      ->Args({64, 4})
      ->Args({64, 8})
      ->Args({2, 0});
});

}  // namespace
}  // namespace psygen::models
