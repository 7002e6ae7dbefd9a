// What the cache of a scene holds, by model type. Reads the scene. Main thread.
#pragma once

#include "editor/cost/world_impact.hpp"

namespace psygen::scene {
class Scene;
}

namespace psygen::editor {

// The meshes of one type.
struct HeldOfType {
  std::uint64_t meshes = 0, triangles = 0, vertices = 0, bytes = 0;
};
// By type of the scene's registry. Counts all meshes.
std::vector<HeldOfType> held_by_type(const scene::Scene& scene);

// For estimates (cost/world_impact.hpp): also what meshes take to make, predicted of a sample. Some
// milliseconds.
CacheContents contents_of(const scene::Scene& scene);

}  // namespace psygen::editor
