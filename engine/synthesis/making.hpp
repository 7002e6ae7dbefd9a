// What modelers need to make a mesh, here or from bytes that came. Not for others.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <new>
#include <vector>

#include "engine/core/out_of_memory.hpp"
#include "engine/synthesis/modeler.hpp"

namespace psygen::synthesis {

// Calls what notes something of a mesh. Whatever it throws fails the request.
template <class Work>
void noting(Completion& c, const Work& work) {
  try {
    work();
  } catch (const std::bad_alloc&) {
    c.ok = false;
    c.error = core::out_of_memory("what is noted of a mesh");
  } catch (const std::exception& e) {
    c.ok = false;
    c.error = fmt::format("nothing could be noted of a mesh: {}", e.what());
  } catch (...) {
    c.ok = false;
    c.error = "nothing could be noted of a mesh";
  }
}

// What is noted of meshes of a type; null: nothing.
inline const Annotate* annotate_of(const Workshop& workshop, models::ModelIndex model) {
  const std::vector<Annotate>& all = workshop.annotate;
  return model < all.size() && all[model] ? &all[model] : nullptr;
}

inline void copy_mesh(const models::MeshView& mesh, const models::MeshView& destination) {
  std::ranges::copy(mesh.vertices, destination.vertices.begin());
  std::ranges::copy(mesh.indices, destination.indices.begin());
}

}  // namespace psygen::synthesis
