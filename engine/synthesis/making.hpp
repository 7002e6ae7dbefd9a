// Helpers shared by local and remote modelers. Private to this folder.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <vector>

#include "engine/core/out_of_memory.hpp"
#include "engine/synthesis/modeler.hpp"

namespace psygen::synthesis {

// Calls a function that annotates a mesh. An exception fails the request.
template <class Work>
void noting(Completion& c, const Work& work) {
  try {
    work();
  } catch (const std::bad_alloc&) {
    c.ok = false;
    c.error = core::out_of_memory("the annotation of a mesh");
  } catch (const std::exception& e) {
    c.ok = false;
    c.error = fmt::format("the annotation of a mesh failed: {}", e.what());
  } catch (...) {
    c.ok = false;
    c.error = "the annotation of a mesh failed";
  }
}

// Annotation function for meshes of a type; null if there is none.
inline const Annotate* annotate_of(const Workshop& workshop, models::ModelIndex model) {
  const std::vector<Annotate>& all = workshop.annotate;
  return model < all.size() && all[model] ? &all[model] : nullptr;
}

// Copies vertices and indices. Both meshes have the same size.
inline void copy_mesh(const models::MeshView& mesh, const models::MeshView& destination) {
  std::ranges::copy(mesh.vertices, destination.vertices.begin());
  std::ranges::copy(mesh.indices, destination.indices.begin());
}

}  // namespace psygen::synthesis
