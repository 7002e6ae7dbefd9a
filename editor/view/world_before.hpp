// Whether the picture still shows something near of a world that was replaced. Reads a scene
// between two of its ticks. Main thread.
#pragma once

#include "engine/scene/state.hpp"

namespace psygen::editor {

// Of blocks in view: their ground, or a model on them that is in view. Not what merged meshes show,
// which is farther.
bool shows_world_before(const scene::State& state);

}  // namespace psygen::editor
