// A triangle mesh as plain lists, as a game's code or a file describes it, before it is packed for
// drawing (scene/objects/packed_mesh.hpp). Metres, +Y up, right-handed, counter-clockwise seen from
// outside, colours as linear albedo. add_ellipsoid() and add_triangle() build meshes in code, such
// as an animal with fins. Not a scene graph, nor a modelling tool. Values; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/core/coordinates.hpp"
#include "engine/core/error.hpp"

namespace psygen::core {

// Lists of vertices, each as long as `positions` or empty, and three indices for each triangle.
struct MeshData {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  // any length but 0; empty: the triangles' normals
  std::vector<glm::vec2> uvs;      // empty: (0, 0). (0, 0) is a texture's upper left corner
  std::vector<glm::vec3> colours;  // 0 … 1; empty: white
  std::vector<std::uint32_t> indices;
};

// Largest distance of a position from the mesh's origin, in metres.
inline constexpr float kMaxMeshReachM = 1e5F;

// Fails with kInvalidArgument and a message that names the list and the element: no triangles,
// lists of different lengths, indices out of range, numbers that are not finite or too large. O(n).
Result<void> check(const MeshData& mesh);

// The most vertices that a mesh for drawing can have.
inline constexpr std::uint32_t kMaxMeshVertices = 65535;

// Splits the mesh into parts of at most `max_vertices` (>= 3) vertices, which share none. The mesh
// must have passed check(). Triangles keep their order. O(n).
std::vector<MeshData> split(const MeshData& mesh, std::uint32_t max_vertices = kMaxMeshVertices);

// Sums for each vertex the normals of its triangles, weighted by area and not normalised; 0 for
// vertices that no triangle uses. All indices must be in range. O(n).
std::vector<glm::vec3> normal_sums(const MeshData& mesh);

// Adds an ellipsoid of kEllipsoidTriangles triangles with these half axes in metres (> 0). `above`
// and `below` colour its upper side and its underside. Adds vertices with normals and colours.
inline constexpr std::size_t kEllipsoidTriangles = 80;
void add_ellipsoid(MeshData& mesh, const glm::vec3& middle, const glm::vec3& half,
                   const glm::vec3& above, const glm::vec3& below);

// Adds one triangle, counter-clockwise seen from outside. Its normals point to its upper side.
void add_triangle(MeshData& mesh, const std::array<glm::vec3, 3>& corners, const glm::vec3& colour);

}  // namespace psygen::core
