// Runs the benchmarks and prints one table of the kernels: medians of the repetitions on every
// instruction set of this CPU and of the plain double-precision reference. All results go to
// psygen_bench_synthesis.json, or to --benchmark_out=FILE.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "tests/bench/run_with_table.hpp"

namespace {

// A line of the table: the benchmark "work/set" with these arguments, and one of its counters.
struct Row {
  const char *work, *arguments, *title, *counter;
  double factor;
  int decimals;
};
constexpr const char *kSeconds = "seconds_each", *kTriangles = "triangles_per_second";
constexpr std::array kRows = {
    Row{"terrain_noise_65x65", "", "terrain, 9 octaves, 65², ns/sample", kSeconds, 1e9, 2},
    Row{"terrain_block_unlit", "", "terrain block, packed, with normals, no light, µs", kSeconds,
        1e6, 1},
    Row{"terrain_block", "level:0/sun:90", "the same with the light of the sky, µs", kSeconds, 1e6,
        1},
    Row{"terrain_block", "level:0/sun:30", "the same with the sun at 30° as well, µs", kSeconds,
        1e6, 1},
    Row{"tree", "level:0", "trees of about 5,000 triangles, Mtri/s", kTriangles, 1e-6, 0},
    Row{"rock", "subdivisions:2", "rocks of 64 triangles, Mtri/s", kTriangles, 1e-6, 0},
    Row{"paper_block", "parts:7", "the paper's block, ms", kSeconds, 1e3, 3},
    Row{"tree_size", "level:0", "size of a tree's mesh, µs", kSeconds, 1e6, 2},
};
constexpr std::array kColumns = {"avx512", "avx2", "sse4", "scalar", "reference"};

// Google Benchmark 1.8 renamed the field.
bool has_result(const auto& run) {
  if constexpr (requires { run.error_occurred; }) {
    return !run.error_occurred;
  } else {
    return run.skipped == decltype(run.skipped){};
  }
}

class TableReporter : public benchmark::ConsoleReporter {
 public:
  TableReporter() : benchmark::ConsoleReporter(OO_None) {}

  void ReportRuns(const std::vector<Run>& runs) override {
    benchmark::ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || !has_result(run)) continue;
      for (const auto& [name, counter] : run.counters)
        figures_[run.run_name.function_name + "|" + run.run_name.args + "|" + name].push_back(
            counter.value);
    }
  }

  void print_table() const {
    std::printf("\n| work | AVX-512 | AVX2 | SSE4 | scalar | reference | ratio |\n");
    std::printf("| --- | --- | --- | --- | --- | --- | --- |\n");
    for (const Row& row : kRows) {
      std::printf("| %s |", row.title);
      double best = 0, last = 0;
      for (const char* column : kColumns) {
        last = figure(row, column);
        if (best == 0) best = last;
        last > 0 ? std::printf(" %.*f |", row.decimals, last) : std::printf(" |");
      }
      const double ratio = row.counter == kTriangles ? best / last : last / best;
      last > 0 ? std::printf(" %.3g |\n", ratio) : std::printf(" |\n");
    }
  }

 private:
  // Returns the median of the repetitions, or 0 without any.
  double figure(const Row& row, const std::string& column) const {
    const auto found = figures_.find(std::string(row.work) + "/" + column + "|" + row.arguments +
                                     "|" + row.counter);
    if (found == figures_.end()) return 0;
    std::vector<double> values = found->second;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle * row.factor;
  }

  std::map<std::string, std::vector<double>> figures_;
};

}  // namespace

int main(int argc, char** argv) {
  return psygen::bench::run_with_table<TableReporter>(argc, argv, "psygen_bench_synthesis.json");
}
