// Fixed steps follow the clock at any frame rate.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "engine/scene/state.hpp"
#include "tests/engine/scene/fixture.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::scene {
namespace {

// A simulation of `hz` whose steps are counted.
struct Steps {
  ecs::World entities;
  Simulation simulation{entities};
  FixedStep step;
  Clock clock;
  Tracing trace;
  int count = 0;

  explicit Steps(double hz) {
    step.step_s = 1 / hz;
    simulation.systems.provide(count);
    simulation.systems.add("count", [](int& n) { ++n; });
  }
  void frame_at(double now_s) {
    clock.now_s = now_s;
    simulation_system(clock, entities, simulation, step, trace);
  }
};

TEST(Simulation, RunsAStepForEachPeriodOfTheClock) {
  for (const double frame_hz : {13.0, 60.0, 144.0, 1000.0}) {
    Steps steps(60);
    for (int i = 0; i <= static_cast<int>(10 * frame_hz); ++i)
      steps.frame_at(i / frame_hz);
    EXPECT_EQ(steps.count, 600) << frame_hz;
    EXPECT_EQ(steps.step.index, 600U);
    EXPECT_NEAR(steps.step.now_s(), 10.0, 1e-9);
    EXPECT_EQ(steps.simulation.lost_s, 0);
  }
}

TEST(Simulation, TellsTheFractionOfAStepSinceTheLastOne) {
  Steps steps(10);
  steps.frame_at(0.25);
  EXPECT_EQ(steps.count, 2);
  EXPECT_NEAR(steps.step.share, 0.5, 1e-6);
  steps.frame_at(0.30);
  EXPECT_EQ(steps.count, 3);
  EXPECT_NEAR(steps.step.share, 0.0, 1e-5);
}

TEST(Simulation, SlowsDownInsteadOfStoppingWhenFramesTakeTooLong) {
  Steps steps(60);
  steps.frame_at(10);
  EXPECT_EQ(steps.count, 8);
  EXPECT_NEAR(steps.simulation.lost_s, 10 - 8 / 60.0, 1e-9);
  steps.frame_at(10 + 1 / 60.0);
  EXPECT_EQ(steps.count, 9);
}

TEST(Simulation, AClockSetBackUndoesNothing) {
  Steps steps(60);
  steps.frame_at(0.1);
  EXPECT_EQ(steps.count, 6);
  steps.frame_at(0);
  EXPECT_EQ(steps.count, 6);
  steps.frame_at(0.05);
  EXPECT_EQ(steps.count, 9);
}

TEST(Simulation, IgnoresATimeThatIsNotANumber) {
  Steps steps(60);
  for (const double never : {std::nan(""), double{INFINITY}, -double{INFINITY}})
    steps.frame_at(never);
  EXPECT_EQ(steps.count, 0);
  steps.frame_at(0.1);
  EXPECT_EQ(steps.count, 6);
}

TEST(Simulation, IsTimedAndTracedSystemBySystem) {
  telemetry::TraceLog log;
  models::Registry registry = models::make_standard_registry();
  const world::World world = paper_world(registry);
  auto made = Scene::create(world, std::move(registry), small_settings(), nullptr, &log);
  ASSERT_TRUE(made) << made.error().message;
  const std::unique_ptr<Scene> scene = std::move(*made);
  State& state = state_of(*scene);
  Systems systems = scene->systems();
  systems.frame.add(
      "look", [](const FixedStep&) {}, ecs::after("simulation"));
  systems.step.add("walk", [](const WorldFacts&) {});
  ASSERT_TRUE(scene->arrange());
  EXPECT_EQ(system_names(state).front(), "simulation");
  EXPECT_EQ(system_names(state)[1], "look");
  EXPECT_EQ(system_names(state).back(), "step walk");
  for (int i = 0; i < 3; ++i)
    tick_at(*scene, pose_at(256, 256));
  ASSERT_EQ(state.system_ms.size(), system_names(state).size());
  EXPECT_GE(state.system_ms.back(), 0.0F);
  const TemporaryFolder folder;
  ASSERT_TRUE(log.write(folder / "trace.json"));
  std::ifstream file(folder / "trace.json");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(text.find("\"walk\""), std::string::npos);
  EXPECT_NE(text.find("\"look\""), std::string::npos);
}

}  // namespace
}  // namespace psygen::scene
