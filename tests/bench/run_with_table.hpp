// Main function of a benchmark that prints a table at the end. All results go to a JSON file, or to
// --benchmark_out=FILE.
#pragma once

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

namespace psygen::bench {

// `Reporter` is a benchmark::ConsoleReporter with print_table(). Returns the exit status.
template <class Reporter>
int run_with_table(int argc, char** argv, const std::string& json_file) {
  std::vector<char*> arguments(argv, argv + argc);
  std::string json = "--benchmark_out=" + json_file;
  arguments.insert(arguments.begin() + 1, json.data());  // a later option wins
  argc = static_cast<int>(arguments.size());
  benchmark::Initialize(&argc, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(argc, arguments.data())) return 2;
  Reporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  reporter.print_table();
  return 0;
}

}  // namespace psygen::bench
