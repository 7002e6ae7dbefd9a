// Vertex colours that replace a texture: means over the triangles around each vertex. Pure; any
// thread.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "engine/core/mesh_data.hpp"
#include "engine/gltf/model.hpp"

namespace psygen::handmade {

// The pixel at a point of the texture, which repeats.
std::span<const std::uint8_t, 4> pixel_of(const image::Image& image, glm::vec2 uv);

// One linear colour for each vertex of the mesh. Pixels below the material's least opacity do not
// count; a vertex without other pixels around it gets the mean of the mesh. Linear in the
// triangles.
std::vector<glm::vec3> texture_colours(const core::MeshData& mesh, const image::Image& image,
                                       float min_opacity);

}  // namespace psygen::handmade
