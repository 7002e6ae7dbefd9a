// The values that no system writes: settings, rules and times of a tick. Values.
#pragma once

#include "engine/scene/frame/clock.hpp"
#include "engine/scene/settings.hpp"

namespace psygen::scene {

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

// Bundle (ecs/README.md).
struct FrameContext {
  const SceneSettings& settings;
  const Rules& rules;
  const Clock& clock;
};

// Fraction of a whole fade by which fades advance in this tick, in (0, 1]. `last_s`: the clock at
// the last tick. A clock that stands still advances them by 1/240 s.
float fade_fraction(const FrameContext& frame, double last_s);

}  // namespace psygen::scene
