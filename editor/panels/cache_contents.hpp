// What the cache of a scene holds, by model type, for estimates (cost/world_impact.hpp). Reads the
// scene. Main thread.
#pragma once

#include "editor/cost/world_impact.hpp"

namespace psygen::scene {
struct State;
}

namespace psygen::editor {

// Counts all meshes; what they take to make is predicted of a sample. Some milliseconds.
CacheContents contents_of(const scene::State& state);

}  // namespace psygen::editor
