// The times of a tick, and the fixed-step simulation. Main thread only.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "ecs/ecs.hpp"

namespace psygen::scene {

struct SceneSettings;
struct Tracing;

struct Clock {
  double now_s = 0;   // of the flight: real, or frame / rate with a fixed step
  double real_s = 0;  // real seconds since the scene was created, for latencies; set by each tick
  std::function<double()> read_real_s;  // source of real_s; returns now_s in virtual time
  std::uint32_t tick = 1;
};

// The simulation's state. Systems of frames and of steps read it.
struct FixedStep {
  double step_s = 1.0 / 60.0;  // > 0
  std::uint64_t index = 0;     // steps that have begun; the first one sees 1
  // Fraction of a step by which the frame is ahead of the last step: 0 … 1. Draw moving entities
  // between their states before and after the last step, at this fraction.
  double share = 0;
  // Simulated seconds at the end of the last step that has begun.
  double now_s() const { return static_cast<double>(index) * step_s; }
};

// The fixed-step simulation of a game. Its systems run once for each step by which the clock has
// advanced, whatever the frame rate is. Results depend only on the number of steps and on their
// input, so they are the same on every machine. Draws nothing.
struct Simulation {
  // Has no systems yet. `entities` must outlive it.
  explicit Simulation(ecs::World& entities) : systems(entities) {}

  ecs::Schedule systems;  // of one step
  // Maximum steps of one frame. A program that cannot keep up slows its simulation down instead of
  // stopping.
  std::uint32_t max_steps = 8;
  double behind_s = 0;  // clock time that no step has simulated yet
  double clock_s = 0;   // the clock at the last frame
  double lost_s = 0;    // time dropped by frames with too many steps
  // Of each system in this frame, summed over its steps: its time, and its work if it is counted.
  std::vector<float> step_ms;
  std::vector<std::uint64_t> step_work;
};

// System: runs the fixed steps that are due. Their systems may change all entities.
void simulation_system(const Clock& clock, ecs::World& entities, Simulation& simulation,
                       FixedStep& step, Tracing& trace);

// Rules of a tick that follow from the paradigm (SceneSettings::paradigm).
struct Rules {
  bool request = true;       // missing meshes are synthesised
  bool wait = false;         // the frame waits for all of them
  bool keep = true;          // the next frame may draw meshes of this one
  bool look_ahead = true;    // nodes out of view get meshes too
  bool coarse_first = true;  // the first mesh of a hole is the coarsest level
  bool settle =
      false;  // before the first frame: levels follow from the pose alone, not from history
};
// The rules before the first frame if `settling`.
Rules rules_of(const SceneSettings& settings, bool settling);

// Bundle (ecs/README.md): the values that no system writes.
struct FrameContext {
  const SceneSettings& settings;
  const Rules& rules;
  const Clock& clock;
};

// The last tick that filled a draw list.
struct DrawnTick {
  std::uint32_t tick = 0;
  double now_s = 0;  // the clock in that tick
};

// The step by which one tick advances all fades of a draw list.
struct FadeStep {
  std::uint32_t tick = 0;
  float share = 1;        // fraction of a whole fade, in (0, 1]; 1: no fades
  bool continues = true;  // the tick before filled the list too
};

// Returns the step of this tick, and records the tick in `last`. A clock that stands still advances
// fades by 1/240 s.
FadeStep next_fade_step(const FrameContext& frame, DrawnTick& last);

}  // namespace psygen::scene
