#include "engine/handmade/triangles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <map>

#include "engine/handmade/alpha_cutout.hpp"
#include "engine/handmade/texture_colours.hpp"
#include "engine/models/kit/packing.hpp"

namespace psygen::handmade {
namespace {

constexpr float kMinSizeM = 0.01F, kMaxSizeM = 1000;

glm::mat4 matrix_of(const gltf::Pose& pose) {
  return glm::translate(glm::mat4(1.0F), pose.translation) * glm::mat4_cast(pose.rotation) *
         glm::scale(glm::mat4(1.0F), pose.scale);
}

// True if a material leaves out pixels of the primitive.
bool is_cut(const gltf::Model& model, const gltf::Primitive& primitive) {
  if (primitive.material == gltf::kNone || primitive.mesh.uvs.empty()) return false;
  const gltf::Material& material = model.materials[primitive.material];
  return material.min_opacity > 0 && material.base_texture != gltf::kNone;
}

// Linear colours of the vertices of a primitive, of which `mesh` is drawn.
std::vector<glm::vec3> colours_of(const gltf::Model& model, const gltf::Primitive& primitive,
                                  const core::MeshData& mesh) {
  std::vector<glm::vec3> colours(mesh.positions.size(), glm::vec3(1.0F));
  if (primitive.material != gltf::kNone) {
    const gltf::Material& material = model.materials[primitive.material];
    if (material.base_texture != gltf::kNone && !mesh.uvs.empty())
      colours = texture_colours(mesh, *model.images[material.base_texture], material.min_opacity);
    for (glm::vec3& colour : colours)
      colour *= material.base_colour;
  }
  if (mesh.colours.empty()) return colours;
  for (std::size_t i = 0; i < colours.size(); ++i)
    colours[i] *= mesh.colours[i];
  return colours;
}

// The drawn part of a primitive, independent of its nodes.
struct Drawn {
  core::MeshData mesh;
  std::vector<glm::vec3> colours;
};

Drawn drawn_of(const gltf::Model& model, const gltf::Primitive& primitive, int depth) {
  Drawn drawn{primitive.mesh, {}};
  if (is_cut(model, primitive)) {
    const gltf::Material& material = model.materials[primitive.material];
    drawn.mesh = alpha_cutout(primitive.mesh, *model.images[material.base_texture],
                              material.opacity, material.min_opacity, depth);
  }
  drawn.colours = colours_of(model, primitive, drawn.mesh);
  return drawn;
}

// The cutting depth, by the number of cards in all nodes.
int depth_for(const gltf::Model& model) {
  std::size_t triangles = 0;
  for (const gltf::Node& node : model.nodes) {
    if (node.mesh == gltf::kNone) continue;
    for (const gltf::Primitive& primitive : model.meshes[node.mesh].primitives)
      triangles += is_cut(model, primitive) ? primitive.mesh.indices.size() / 3 : 0;
  }
  return cut_depth(triangles);
}

void add(const gltf::Model& model, const gltf::Primitive& primitive, const Drawn& drawn,
         const glm::mat4& placed, Triangles& out) {
  const core::MeshData& mesh = drawn.mesh;
  const glm::mat3 linear(placed);
  // The matrix of cofactors, which transforms normals correctly for any scale.
  const glm::mat3 normals(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                          glm::cross(linear[0], linear[1]));
  const bool mirrored = glm::determinant(linear) < 0;
  const std::vector<glm::vec3>& colours = drawn.colours;
  const bool leaf =
      primitive.material != gltf::kNone && model.materials[primitive.material].min_opacity > 0;
  const auto first = static_cast<std::uint32_t>(out.vertices.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    Vertex v;
    v.position = glm::vec3(placed * glm::vec4(mesh.positions[i], 1.0F));
    if (!mesh.normals.empty()) {
      const glm::vec3 n = (mirrored ? -1.0F : 1.0F) * (normals * mesh.normals[i]);
      const float length = glm::length(n);
      if (length > 0 && std::isfinite(length)) v.normal = n / length;
    }
    for (std::size_t c = 0; c < 3; ++c)
      v.colour[c] = models::pack_albedo(colours[i][static_cast<int>(c)]);
    v.leaf = leaf ? 1 : 0;
    out.vertices.push_back(v);
  }
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t *t = &mesh.indices[i], b = mirrored ? 2 : 1, c = mirrored ? 1 : 2;
    out.indices.insert(out.indices.end(), {first + t[0], first + t[b], first + t[c]});
  }
}

// Bounds of all triangles; files may have more vertices.
core::Bounds box_of(const Triangles& triangles) {
  const glm::vec3 first = triangles.vertices[triangles.indices.front()].position;
  core::Bounds box{first, first};
  for (const std::uint32_t i : triangles.indices) {
    const glm::vec3& p = triangles.vertices[i].position;
    box = {glm::min(box.min, p), glm::max(box.max, p)};
  }
  return box;
}

// Scales the model, and puts its base point at the centre of its base.
core::Result<void> place(const world::HandmadeModel& how, Triangles& out) {
  const core::Bounds box = box_of(out);
  const glm::vec3 size = box.max - box.min;
  const float most = std::max({size.x, size.y, size.z});
  if (how.size_m > 0 && !(size.y > 1e-4F * most))
    return core::fail(core::ErrorCode::kParse,
                      "it is flat, so size_m cannot set its height; use scale");
  const float scale =
      static_cast<float>(how.size_m > 0 ? how.size_m / static_cast<double>(size.y) : how.scale);
  if (!(scale * most >= kMinSizeM && scale * most <= kMaxSizeM))
    return core::fail(core::ErrorCode::kParse,
                      fmt::format("its size would be {:.3g} m; allowed: {} to {} m", scale * most,
                                  kMinSizeM, kMaxSizeM));
  const glm::vec3 foot{0.5F * (box.min.x + box.max.x), box.min.y, 0.5F * (box.min.z + box.max.z)};
  for (Vertex& v : out.vertices)
    v.position = scale * (v.position - foot) - glm::vec3(0, static_cast<float>(how.sink_m), 0);
  out.box = box_of(out);
  return {};
}

}  // namespace

gltf::Limits gltf_limits() {
  gltf::Limits limits;
  limits.bytes = std::uint64_t{128} << 20;
  limits.vertices = kMaxVertices;
  limits.indices = 6 * kMaxVertices;
  limits.images = {.max_width = 4096,
                   .max_height = 4096,
                   .max_bytes = std::uint64_t{64} << 20,
                   .max_file_bytes = std::uint64_t{32} << 20};
  return limits;
}

core::Result<Triangles> triangles_of(const gltf::Model& model, const world::HandmadeModel& how) {
  Triangles out;
  std::vector<glm::mat4> placed;
  std::map<const gltf::Primitive*, Drawn> known;  // nodes may share meshes
  const int depth = depth_for(model);
  for (const gltf::Node& node : model.nodes) {
    const glm::mat4 own = matrix_of(node.rest);
    placed.push_back(node.parent == gltf::kNone ? own : placed[node.parent] * own);
    if (node.mesh == gltf::kNone) continue;
    for (const gltf::Primitive& primitive : model.meshes[node.mesh].primitives) {
      const auto [drawn, is_new] = known.try_emplace(&primitive);
      if (is_new) drawn->second = drawn_of(model, primitive, depth);
      const core::MeshData& mesh = drawn->second.mesh;
      if (out.vertices.size() + mesh.positions.size() > kMaxVertices ||
          out.indices.size() + mesh.indices.size() > 6 * kMaxVertices)
        return core::fail(core::ErrorCode::kOverBudget,
                          fmt::format("with all its nodes it has more than {} vertices or {} "
                                      "triangles",
                                      kMaxVertices, 2 * kMaxVertices));
      add(model, primitive, drawn->second, placed.back(), out);
    }
  }
  const auto finite = [](const Vertex& v) {
    return std::isfinite(v.position.x + v.position.y + v.position.z);
  };
  if (out.indices.empty()) return core::fail(core::ErrorCode::kParse, "it has no triangles");
  if (!std::ranges::all_of(out.vertices, finite))
    return core::fail(core::ErrorCode::kParse, "its nodes move it to infinity");
  if (auto ok = place(how, out); !ok) return tl::unexpected(ok.error());
  return out;
}

}  // namespace psygen::handmade
