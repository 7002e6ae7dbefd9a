// Converts a finished mesh of the engine to an object of a document. Pure, any thread, linear in
// the mesh. It synthesises nothing and writes no files.
#pragma once

#include "engine/core/error.hpp"
#include "engine/exchange/document.hpp"
#include "engine/models/model_type.hpp"
#include "engine/world/world.hpp"

namespace psygen::exchange {

// The object of a mesh. `mesh` was written by type.synthesise(p, level, mesh), and `size` is
// type.mesh_size(p, level). Terrain is coloured by `palette` (world::drawn_palette). Its skirts
// hang by `skirt_m` metres; 0 removes them. Other models keep every vertex that a triangle uses.
// Fails with kSynthesisFailed if an index is out of range or the type throws, and with kOutOfMemory
// if memory is exhausted.
core::Result<Object> unpack(const models::ModelType& type, const models::Parameters& p, int level,
                            const models::MeshSize& size, const models::MeshView& mesh,
                            const world::Palette& palette, float skirt_m = 0);

}  // namespace psygen::exchange
