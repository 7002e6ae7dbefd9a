// The content of a glTF file as plain values: meshes, materials, images, a hierarchy of nodes and
// their animations (read_file.hpp reads them). Metres, seconds, +Y up, right-handed, as in glTF.
// Draws nothing: scene/objects/prefab.hpp puts it into a world. Values; any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <string>
#include <vector>

#include "engine/core/mesh_data.hpp"
#include "engine/image/image_cache.hpp"

namespace psygen::gltf {

// Stands for no index.
inline constexpr std::uint32_t kNone = UINT32_MAX;

// The triangles of one material. They have passed core::check().
struct Primitive {
  core::MeshData mesh;
  std::uint32_t material = kNone;  // index into Model::materials
};
struct Mesh {
  std::string name;
  std::vector<Primitive> primitives;  // not empty, unless it had only points and lines
};

// Textures are indices into Model::images.
struct Material {
  std::string name;
  glm::vec3 base_colour{1.0F};  // linear albedo, multiplied with texture and vertex colours
  float opacity = 1;
  float min_opacity = 0;      // pixels below it are not drawn; 0: all are drawn
  glm::vec3 emissive{0.0F};   // linear
  float normal_strength = 1;  // scale of the normal map
  std::uint32_t base_texture = kNone, normal_texture = kNone, emissive_texture = kNone;
  bool two_sided = false;
};

// The transform relative to the parent: scale, then rotation, then translation.
struct Pose {
  glm::vec3 translation{0.0F};
  glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};  // w, x, y, z; unit length
  glm::vec3 scale{1.0F};
};

struct Node {
  std::string name;
  std::uint32_t parent = kNone;  // a smaller index than its own
  std::uint32_t mesh = kNone;    // index into Model::meshes
  Pose rest;                     // pose without animations
};

// The interpolation between two values, and the animated property of a node.
enum class Interpolation : std::uint8_t { kStep, kLinear, kCubic };
enum class Property : std::uint8_t { kTranslation, kRotation, kScale };

// The animation of one property of one node. Times ascend; a value has x, y, z, and w for rotations
// (x, y, z, w). kCubic has three values for each time: the in-tangent, the value, the out-tangent.
struct Channel {
  std::uint32_t node = 0;
  Property property = Property::kTranslation;
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<float> times_s;
  std::vector<glm::vec4> values;
};
struct Animation {
  std::string name;
  float duration_s = 0;  // the last time of all channels
  std::vector<Channel> channels;
};

// The content of one file.
struct Model {
  std::string name;  // file name without its folder
  std::vector<Mesh> meshes;
  std::vector<Material> materials;
  std::vector<image::ImagePtr> images;  // not null; other models may share them
  std::vector<Node> nodes;  // the nodes of the file's scene, parents before their children
  std::vector<Animation> animations;
  // Features of the file that the engine does not support, one sentence each: skins, morph targets,
  // blending, points and lines, extensions. Each begins with the file's path.
  std::vector<std::string> notes;
  // The files that this file names and uses, in its folder or below: buffers and images.
  std::vector<std::filesystem::path> files;
  // Images that it uses and that do not exist; materials are drawn without them.
  std::vector<std::filesystem::path> missing;
};

}  // namespace psygen::gltf
