
#include "engine/scene/frame/clock.hpp"

#include <algorithm>
#include <cmath>

#include "engine/scene/frame/output.hpp"
#include "engine/scene/settings.hpp"

namespace psygen::scene {
namespace {

// A step is due this fraction of a step early: sums of frame times are not exact.
constexpr double kEarly = 1e-6;

}  // namespace

void simulation_system(const Clock& clock, ecs::World&, Simulation& simulation, FixedStep& step,
                       Tracing& trace) {
  if (!std::isfinite(clock.now_s)) return;
  // A clock that is set back does not undo steps.
  simulation.behind_s += std::max(clock.now_s - simulation.clock_s, 0.0);
  simulation.clock_s = clock.now_s;
  const double max_s = step.step_s * simulation.max_steps;
  if (simulation.behind_s > max_s) {
    simulation.lost_s += simulation.behind_s - max_s;
    simulation.behind_s = max_s;
  }
  simulation.step_ms.assign(simulation.systems.systems().size(), 0.0F);
  simulation.step_work.assign(simulation.step_ms.size(), 0);
  while (simulation.behind_s >= step.step_s * (1 - kEarly)) {
    simulation.behind_s = std::max(simulation.behind_s - step.step_s, 0.0);
    ++step.index;
    step.share = 0;
    simulation.systems.run();
    const auto systems = simulation.systems.systems();
    for (std::size_t i = 0; i < systems.size(); ++i) {
      simulation.step_ms[i] += static_cast<float>(systems[i].last_seconds * 1000.0);
      simulation.step_work[i] += systems[i].last_work;
    }
    trace_systems(systems, step.index, &Tracing::steps, trace);
  }
  step.share = std::min(simulation.behind_s / step.step_s, 1.0);
}

Rules rules_of(const SceneSettings& settings, bool settling) {
  const bool lazy = settings.paradigm == Paradigm::kLazyEvaluation;
  const bool pla = settings.paradigm == Paradigm::kParallelLazyAmplification;
  return {.request = settings.paradigm != Paradigm::kDataAmplification,
          .wait = lazy,
          .keep = !lazy,
          .look_ahead = pla,
          .coarse_first = pla && settings.levels_of_detail,
          .settle = settling};
}

FadeStep next_fade_step(const FrameContext& frame, DrawnTick& last) {
  constexpr double kMinSeconds = 1.0 / 240.0;
  const Clock& clock = frame.clock;
  const double passed_s = std::max(clock.now_s - last.now_s, kMinSeconds);
  const double whole_s = frame.settings.fade_seconds;
  const FadeStep step{clock.tick,
                      whole_s <= passed_s ? 1.0F : static_cast<float>(passed_s / whole_s),
                      last.tick + 1 == clock.tick};
  last = {clock.tick, clock.now_s};
  return step;
}

}  // namespace psygen::scene
