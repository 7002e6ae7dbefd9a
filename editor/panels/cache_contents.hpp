// Cache contents of a scene, by model type. Reads the scene. Main thread.
#pragma once

#include <map>

#include "editor/cost/world_impact.hpp"

namespace psygen::scene {
class Scene;
}

namespace psygen::editor {

// The cached meshes of one model type.
struct TypeContents {
  models::ModelIndex model = 0;
  std::uint64_t meshes = 0, triangles = 0, vertices = 0, bytes = 0;
};
// Contents of the types with cached meshes, by name. Counts all meshes.
std::map<std::string, TypeContents> contents_by_type(const scene::Scene& scene);

// Contents with predicted synthesis times, for estimates (cost/world_impact.hpp). The times are
// means over a sample of the meshes. Takes some milliseconds.
CacheContents contents_of(const scene::Scene& scene);

}  // namespace psygen::editor
