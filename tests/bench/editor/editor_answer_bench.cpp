// Response time of the editor in its window on a private display: from a change to the first frame
// that shows it, and to the last mesh. Meshes are coarse during a drag. On a busy machine, read the
// processor time of all threads instead of the elapsed time.
#include <benchmark/benchmark.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <string>

#include "editor/pictures/picture_server.hpp"
#include "editor/shell/edit_feedback.hpp"
#include "editor/shell/main_window.hpp"
#include "engine/scene/scene.hpp"
#include "tests/editor/own_display.hpp"
#include "tests/source_file.hpp"

namespace psygen::editor {
namespace {

constexpr int kLongestMs = 300'000;

// Milliseconds until the first frame and until the last mesh; negative: not yet.
struct Answer {
  double first_ms = -1, last_ms = -1;
};

// Processor milliseconds of this process, or of this thread.
double cpu_ms(int who = RUSAGE_SELF) {
  rusage used{};
  ::getrusage(who, &used);
  const auto ms = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_usec) * 1e-3;
  };
  return ms(used.ru_utime) + ms(used.ru_stime);
}

std::unique_ptr<MainWindow> open_window(const std::filesystem::path& state, Answer& answer) {
  MainWindowOptions options;
  options.session.preset = render::Preset::kLow;
  options.document.state_folder = state;
  auto window = std::make_unique<MainWindow>(std::move(options));
  QObject::connect(&window->view(), &WorldView::answered, window.get(),
                   [&answer](double ms) { answer.first_ms = ms; });
  QObject::connect(&window->view(), &WorldView::settled, window.get(),
                   [&answer](double ms) { answer.last_ms = ms; });
  window->show();
  window->use_first_pose();
  window->open_file(source_file(std::string("game/worlds/") + kFirstWorld + ".toml"));
  wait_until([&] { return answer.last_ms >= 0; }, kLongestMs);
  return window;
}

void steps(benchmark::State& state, bool held, const world::TextPath& path, const char* low,
           const char* high) {
  const std::filesystem::path home =
      std::filesystem::temp_directory_path() / ("psygen_answer_" + std::to_string(::getpid()));
  Answer answer;
  auto window = open_window(home, answer);
  auto& feedback = *window->findChild<EditFeedback*>();
  bool first = true;
  double last_ms = 0, first_cpu_ms = 0, main_cpu_ms = 0;
  for (auto _ : state) {
    answer = {};
    const double start_ms = cpu_ms(), main_start_ms = cpu_ms(RUSAGE_THREAD);
    if (held) feedback.set_dragging(true);
    (void)window->document().set_value(path, std::exchange(first, !first) ? high : low);
    if (!wait_until([&] { return answer.first_ms >= 0; }, kLongestMs))
      state.SkipWithError("no answer");
    first_cpu_ms += cpu_ms() - start_ms;
    main_cpu_ms += cpu_ms(RUSAGE_THREAD) - main_start_ms;
    state.SetIterationTime(answer.first_ms * 1e-3);
    if (held) feedback.set_dragging(false);
    if (!wait_until([&] { return answer.last_ms >= 0; }, kLongestMs))
      state.SkipWithError("it does not settle");
    last_ms += answer.last_ms;
  }
  const auto mean = [](double sum) {
    return benchmark::Counter(sum, benchmark::Counter::kAvgIterations);
  };
  state.counters["cpu_ms"] = mean(first_cpu_ms);
  state.counters["main_cpu_ms"] = mean(main_cpu_ms);
  state.counters["last_mesh_ms"] = mean(last_ms);
  window.reset();
  std::error_code ignored;
  std::filesystem::remove_all(home, ignored);
}

void trees(benchmark::State& state, bool held) {
  steps(state, held, {"scatter", 0, "size_m"}, "[2.2, 3.4]", "[2.2, 3.3]");
}
void ground(benchmark::State& state, bool held) {
  steps(state, held, {"terrain", "height"}, "1.15", "1.14");
}
void sky(benchmark::State& state, bool held) {
  steps(state, held, {"sky", "exposure"}, "1", "1.1");
}
BENCHMARK_CAPTURE(trees, held, true)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(12);
BENCHMARK_CAPTURE(trees, typed, false)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(12);
BENCHMARK_CAPTURE(ground, held, true)
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime()
    ->Iterations(12);
BENCHMARK_CAPTURE(sky, held, true)->Unit(benchmark::kMillisecond)->UseManualTime()->Iterations(12);

}  // namespace
}  // namespace psygen::editor

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], psygen::editor::kPicturesOption) == 0)
    return psygen::editor::render_pictures({});
  const auto display = psygen::editor::OwnDisplay::start();
  if (!display) return 1;
  const QApplication application(argc, argv);
  QApplication::setOrganizationName("psygen");
  QApplication::setApplicationName("psygen-editor-bench");
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
