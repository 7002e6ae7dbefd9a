// Runs the benchmarks and prints one line per operation: ns per entity of the library and of the
// floor, and their ratio. All results go to psygen_bench_ecs.json, or to --benchmark_out=FILE.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "tests/bench/run_with_table.hpp"

namespace {

// Keeps the best repetition of each benchmark: the machine only ever adds time.
class TableReporter : public benchmark::ConsoleReporter {
 public:
  TableReporter() : benchmark::ConsoleReporter(OO_None) {}

  void ReportRuns(const std::vector<Run>& runs) override {
    benchmark::ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      const auto items = run.counters.find("items_per_second");
      if (run.run_type != Run::RT_Iteration || items == run.counters.end()) continue;
      const std::string name = run.run_name.function_name;
      const std::size_t slash = name.rfind('/');
      Figures& figures = table_[name.substr(0, slash)];
      double& best = name.substr(slash + 1) == "floor" ? figures.floor_ns : figures.ecs_ns;
      const double ns = 1e9 / items->second;
      best = best == 0 ? ns : std::min(best, ns);
    }
  }

  void print_table() const {
    std::printf("\n| operation | floor, ns per entity | ecs, ns per entity | ratio |\n");
    std::printf("| --- | --- | --- | --- |\n");
    for (const auto& [name, figures] : table_) {
      if (figures.floor_ns > 0 && figures.ecs_ns > 0) {
        std::printf("| %s | %.2f | %.2f | %.2f |\n", name.c_str(), figures.floor_ns, figures.ecs_ns,
                    figures.ecs_ns / figures.floor_ns);
      } else {
        std::printf("| %s | | %.2f | |\n", name.c_str(), figures.ecs_ns);
      }
    }
  }

 private:
  struct Figures {
    double floor_ns = 0;
    double ecs_ns = 0;
  };
  std::map<std::string, Figures> table_;
};

}  // namespace

int main(int argc, char** argv) {
  return psygen::bench::run_with_table<TableReporter>(argc, argv, "psygen_bench_ecs.json");
}
