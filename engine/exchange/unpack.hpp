// Turns a finished mesh of the engine into an object of a document. Any thread.
#pragma once

#include "engine/core/error.hpp"
#include "engine/exchange/document.hpp"
#include "engine/models/model_type.hpp"
#include "engine/world/world.hpp"

namespace psygen::exchange {

// `mesh` is what type.synthesize(p, level, mesh) wrote, `size` its type.mesh_size(p, level).
// Terrain is coloured by `palette` (world::drawn_palette) and loses its skirts; other models keep
// every vertex that a triangle uses. Fails with kSynthesisFailed where an index names no vertex or
// the type throws.
core::Result<Object> unpack(const models::ModelType& type, const models::Parameters& p, int level,
                            const models::MeshSize& size, const models::MeshView& mesh,
                            const world::Palette& palette);

}  // namespace psygen::exchange
