// Shapes for meshes that code builds, such as an animal of ellipsoids and fins. Each function adds
// vertices with normals and colours, and triangles. Not a modelling tool. Pure; any thread.
#pragma once

#include <array>

#include "engine/core/mesh_data.hpp"

namespace psygen::core {

// Adds an ellipsoid of kEllipsoidTriangles triangles with these half axes in metres (> 0). `above`
// and `below` colour its upper side and its underside.
inline constexpr std::size_t kEllipsoidTriangles = 80;
void add_ellipsoid(MeshData& mesh, const glm::vec3& middle, const glm::vec3& half,
                   const glm::vec3& above, const glm::vec3& below);

// Adds one triangle, counter-clockwise seen from outside. Its normals point to its upper side.
void add_triangle(MeshData& mesh, const std::array<glm::vec3, 3>& corners, const glm::vec3& colour);

}  // namespace psygen::core
