// Converts a finished mesh of the engine to an object of a document. Pure, any thread, linear in
// the mesh. It synthesises nothing and writes no files.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

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

// The albedo of the ground, the same as in shaders/ground.glsl: the colours of the kinds of ground
// (world/ground_blends.hpp), with grain. Pure, any thread, constant time.
// Linear albedo of a point. `pattern_place_m` comes from world::pattern_place(). `normal` has unit
// length; `packed_height` is core::TerrainVertex::height and seeds the grain; `road` is
// TerrainVertex::road, 0 … 1.
glm::vec3 ground_albedo(const world::Palette& palette, float height_m, const glm::vec3& normal,
                        glm::vec2 pattern_place_m, std::uint16_t packed_height, float road = 0.0F);

}  // namespace psygen::exchange
