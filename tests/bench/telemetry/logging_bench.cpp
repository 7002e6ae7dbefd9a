// Cost of logging one frame of a flight: its row, system times, trace spans and two trace counters,
// samples of a busy frame, and clock reads. Bounded logs are full, as after a long flight. Also the
// cost of a game's figures.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "engine/core/clock.hpp"
#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/own_figures.hpp"
#include "engine/telemetry/trace_log.hpp"

namespace psygen::telemetry {
namespace {

constexpr std::size_t kSystems = 20, kLandings = 8;  // per frame

void a_frame_is_logged(benchmark::State& state) {
  std::vector<std::string> systems;
  for (std::size_t i = 0; i < kSystems; ++i)
    systems.push_back("system " + std::to_string(i));
  FrameLog log(systems, std::size_t{1} << 22);
  TraceLog trace;
  const TraceLog::Track main = trace.add_track("main"), bytes = trace.add_counter("cache"),
                        requests = trace.add_counter("requests");
  std::vector<TraceLog::Name> names;
  for (const std::string& system : systems)
    names.push_back(trace.intern(system));
  std::vector<float> system_ms(kSystems, 0.2F);
  FrameRecord record;
  for (auto _ : state) {
    const double start_s = core::monotonic_seconds(), cpu_s = core::thread_cpu_seconds();
    const double asleep_s = core::suspended_seconds();
    for (std::size_t i = 0; i < kSystems; ++i)
      trace.add_span(main, names[i], start_s, start_s + 1e-4, record.index);
    trace.add_value(bytes, start_s, 1e8);
    trace.add_value(requests, start_s, 40);
    for (std::size_t i = 0; i < kLandings; ++i) {
      log.add_time_to_visible(record.time_s, 12);
      log.add_cost_error(record.time_s, 1e-4, 1.1e-4);
    }
    record.frame_ms = (core::monotonic_seconds() - start_s) * 1000;
    record.main_cpu_ms = (core::thread_cpu_seconds() - cpu_s) * 1000;
    benchmark::DoNotOptimize(core::suspended_seconds() - asleep_s);
    log.add(record, system_ms);
    record.time_s += 1.0 / 60;
    ++record.index;
  }
}
BENCHMARK(a_frame_is_logged)->Iterations(100'000)->Unit(benchmark::kMicrosecond);

constexpr std::size_t kFigures = 100;

// One value of a counter, which is the dearest kind.
void a_value_is_reported(benchmark::State& state) {
  OwnFigures figures;
  OwnFigure figure = *figures.add({.name = "sum", .kind = FigureKind::kCounter});
  for (auto _ : state)
    figure.report(1.5);
}
BENCHMARK(a_value_is_reported);

// The same, of a scope with two readings of the clock.
void a_scope_is_timed(benchmark::State& state) {
  OwnFigures figures;
  OwnFigure figure = *figures.add({.name = "scope_ms", .kind = FigureKind::kDuration});
  for (auto _ : state) {
    const ScopedTime time(figure);
    benchmark::ClobberMemory();
  }
}
BENCHMARK(a_scope_is_timed);

// A frame with 100 figures: a value of each, the end of the frame, its row and its counters in the
// trace, as in a flight.
void a_hundred_figures_of_a_frame(benchmark::State& state) {
  OwnFigures figures;
  TraceLog trace;
  std::vector<OwnFigure> handles;
  std::vector<TraceLog::Track> counters;
  for (std::size_t i = 0; i < kFigures; ++i) {
    const FigureKind kind = i % 2 == 0 ? FigureKind::kCounter : FigureKind::kGauge;
    handles.push_back(*figures.add({.name = "figure_" + std::to_string(i), .kind = kind}));
    counters.push_back(trace.add_counter("figure_" + std::to_string(i)));
  }
  FrameLog log({}, std::size_t{1} << 18, {figures.infos().begin(), figures.infos().end()});
  std::vector<double> values;
  FrameRecord record;
  for (auto _ : state) {
    for (OwnFigure& figure : handles)
      figure.report(record.time_s);
    figures.take(values);
    log.add(record, {}, values);
    for (std::size_t i = 0; i < kFigures; ++i)
      trace.add_value(counters[i], record.time_s, values[i]);
    record.time_s += 1.0 / 60;
  }
}
BENCHMARK(a_hundred_figures_of_a_frame)->Iterations(100'000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace psygen::telemetry

BENCHMARK_MAIN();
