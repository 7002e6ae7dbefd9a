// The simulation of a game in fixed steps: systems of their own that run as often as the clock has
// moved on by a step, whatever the frame rate is. What they compute depends only on the number of
// steps and on their input, so it is the same on every machine. Nothing here draws. Main thread.
#pragma once

#include <cstdint>

#include "ecs/ecs.hpp"

namespace psygen::scene {

// Where the simulation stands. Systems of both kinds read it.
struct FixedStep {
  double step_s = 1.0 / 60.0;  // > 0
  std::uint64_t index = 0;     // steps that have begun; the first one sees 1
  // Of a step, the part by which the picture is ahead of the last step: 0 … 1. What moves is drawn
  // between the state before the last step and the state after it, at this share.
  double share = 0;
  // Time of the simulation in seconds, at the end of the last step that has begun.
  double now_s() const { return static_cast<double>(index) * step_s; }
};

struct Simulation {
  // Without systems. `entities` must outlive it.
  explicit Simulation(ecs::World& entities) : systems(entities) {}

  FixedStep step;
  ecs::Schedule systems;  // of one step
  // Steps that one frame runs at most. A program that cannot keep up slows its simulation down
  // instead of stopping.
  std::uint32_t max_steps = 8;
  double behind_s = 0;         // by which the clock is ahead of the simulation
  double clock_s = 0;          // the clock at the last frame
  double lost_s = 0;           // what frames with too many steps left out
  std::vector<float> step_ms;  // of each system in this frame, over all its steps
};

}  // namespace psygen::scene
