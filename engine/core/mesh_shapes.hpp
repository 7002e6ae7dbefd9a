// Shapes from which code puts a mesh together, such as an animal of ellipsoids and fins. Each adds
// vertices with normals and colours, and triangles. Not a modelling tool. Pure; any thread.
#pragma once

#include <array>

#include "engine/core/mesh_data.hpp"

namespace psygen::core {

// An ellipsoid with these half axes in metres (> 0), of kEllipsoidTriangles. The colours are those
// of its upper side and of its underside.
inline constexpr std::size_t kEllipsoidTriangles = 80;
void add_ellipsoid(MeshData& mesh, const glm::vec3& middle, const glm::vec3& half,
                   const glm::vec3& above, const glm::vec3& below);

// One triangle, counter-clockwise seen from outside; its normals are on the upper side.
void add_triangle(MeshData& mesh, const std::array<glm::vec3, 3>& corners, const glm::vec3& colour);

}  // namespace psygen::core
