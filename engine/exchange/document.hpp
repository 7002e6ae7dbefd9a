// Meshes for other programs: full precision, one list of vertices per material, metres, +Y up,
// right-handed, counter-clockwise from outside. Plain values with the content of the engine's
// packed formats (core/vertex_layout.hpp), but without level-of-detail morphing, skirts, sway and
// ambient visibility. Not a scene graph.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "engine/core/coordinates.hpp"

namespace psygen::exchange {

// Materials: core::ModelVertex::material, or kGround for terrain, kWater for surfaces of water.
inline constexpr std::uint8_t kSolid = 0, kLeaf = 1, kWater = 254, kGround = 255;
// The name of a material in files.
std::string material_name(
    std::uint8_t material);  // "solid", "leaf", "water", "ground", "material_7"

// The triangles of one material of an object.
struct Part {
  std::uint8_t material = kSolid;
  std::vector<glm::vec3> positions;    // local to the object
  std::vector<glm::vec3> normals;      // one per position, unit length
  std::vector<glm::vec3> colours;      // one per position, linear albedo
  std::vector<std::uint32_t> indices;  // three per triangle
};

// One model or terrain block.
struct Object {
  std::string name;
  glm::vec3 position{0.0F};  // position of its origin in the document
  std::vector<Part> parts;
};

// The content of one file.
struct Document {
  std::string name;
  std::vector<Object> objects;
  glm::dvec3 origin{0.0};  // position of the document; written to .glb files only
  // Sums over all parts.
  std::uint64_t vertex_count() const;
  std::uint64_t triangle_count() const;
};

}  // namespace psygen::exchange
