// Cache contents of a scene, by model type. Reads the scene. Main thread.
#pragma once

#include "editor/cost/world_impact.hpp"

namespace psygen::scene {
class Scene;
}

namespace psygen::editor {

// The cached meshes of one model type.
struct TypeContents {
  std::uint64_t meshes = 0, triangles = 0, vertices = 0, bytes = 0;
};
// Contents by index of the model type in the scene's registry. Counts all meshes.
std::vector<TypeContents> contents_by_type(const scene::Scene& scene);

// Contents with predicted synthesis times, for estimates (cost/world_impact.hpp). The times are
// means over a sample of the meshes. Takes some milliseconds.
CacheContents contents_of(const scene::Scene& scene);

}  // namespace psygen::editor
