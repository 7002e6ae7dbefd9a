// The fixed-step simulation of a game. Its systems run once for each step by which the clock has
// advanced, whatever the frame rate is. Results depend only on the number of steps and on their
// input, so they are the same on every machine. Draws nothing. Main thread only.
#pragma once

#include <cstdint>
#include <vector>

#include "ecs/ecs.hpp"
#include "engine/scene/frame/clock.hpp"

namespace psygen::scene {

struct Simulation {
  // Has no systems yet. `entities` must outlive it.
  explicit Simulation(ecs::World& entities) : systems(entities) {}

  ecs::Schedule systems;  // of one step
  // Maximum steps of one frame. A program that cannot keep up slows its simulation down instead of
  // stopping.
  std::uint32_t max_steps = 8;
  double behind_s = 0;         // clock time that no step has simulated yet
  double clock_s = 0;          // the clock at the last frame
  double lost_s = 0;           // time dropped by frames with too many steps
  std::vector<float> step_ms;  // of each system in this frame, summed over its steps
};

struct Tracing;

// System: runs the fixed steps that are due. Their systems may change all entities.
void simulation_system(const Clock& clock, ecs::World& entities, Simulation& simulation,
                       FixedStep& step, Tracing& trace);

}  // namespace psygen::scene
