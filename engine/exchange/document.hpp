// Meshes as other programs want them: full precision, one list of vertices per material, metres, +Y
// up, right-handed, counter-clockwise from outside. Plain values; what the packed formats of the
// engine (core/vertex_layout.hpp) hold, without level-of-detail morphing, skirts, sway and ambient
// visibility. Not a scene graph.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace psygen::exchange {

// One material of an object. `material` is core::ModelVertex::material; terrain has kGround.
inline constexpr std::uint8_t kSolid = 0, kLeaf = 1, kGround = 255;
std::string material_name(std::uint8_t material);  // "solid", "leaf", "ground", "material_7"

struct Part {
  std::uint8_t material = kSolid;
  std::vector<glm::vec3> positions;  // local to the object
  std::vector<glm::vec3> normals;    // unit length; as many
  std::vector<glm::vec3> colours;    // linear albedo; as many
  std::vector<std::uint32_t> indices;
};

struct Object {
  std::string name;
  glm::vec3 position{0.0F};  // of its origin in the document
  std::vector<Part> parts;
};

struct Document {
  std::string name;
  std::vector<Object> objects;
  std::uint64_t vertex_count() const;
  std::uint64_t triangle_count() const;
};

}  // namespace psygen::exchange
