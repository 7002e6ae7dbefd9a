// Meshes: lists of vertices, and triangles of lists, strips and fans.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>
#include <span>

#include "engine/gltf/draco.hpp"
#include "engine/gltf/reading.hpp"

namespace psygen::gltf {
namespace {

using core::MeshData;

// One primitive that is being read.
struct Part {
  Reading& reading;
  const PrimitiveJson& described;
  std::string name;                       // "meshes[0].primitives[0]"
  std::optional<Unpacked> unpacked = {};  // if it is compressed by Draco
};

// The elements of an attribute; nothing if the primitive has none of this name.
core::Result<std::optional<Elements>> attribute(const Part& part, const std::string& which,
                                                std::size_t count, int min_width, int max_width) {
  const auto found = part.described.attributes.find(which);
  if (found == part.described.attributes.end()) return std::optional<Elements>{};
  const std::string what = which + " of " + part.name;
  auto elements = part.unpacked ? elements_of(*part.unpacked, which)
                                : elements_of(part.reading, found->second, what);
  if (!elements) return tl::unexpected(elements.error());
  if (elements->width < min_width || elements->width > max_width)
    return wrong(fmt::format("{} has {} components", what, elements->width));
  if (count != SIZE_MAX && elements->count != count)
    return wrong(fmt::format("{} has {} elements for {} vertices", what, elements->count, count));
  return std::optional(std::move(*elements));
}

template <class Vector>
core::Result<void> read_attribute(const Part& part, const std::string& which, std::size_t count,
                                  int max_width, std::vector<Vector>& out) {
  const auto elements = attribute(part, which, count, Vector::length(), max_width);
  if (!elements) return tl::unexpected(elements.error());
  if (!*elements) return {};
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    out.push_back(vector_of<Vector>(**elements, i));
  return {};
}

core::Result<void> read_vertices(const Part& part, MeshData& mesh) {
  Reading& reading = part.reading;
  const auto positions = attribute(part, "POSITION", SIZE_MAX, 3, 3);
  if (!positions) return tl::unexpected(positions.error());
  if (!*positions) return wrong(part.name + " has no POSITION");
  const std::size_t count = (*positions)->count;
  if (auto ok = add_within_limit(reading.vertices, count, reading.limits.vertices, "vertices"); !ok)
    return ok;
  const int material = part.described.material;
  const Coordinates coordinates =
      material < 0 ? Coordinates{} : reading.coordinates[static_cast<std::size_t>(material)];
  const std::string set = fmt::format("TEXCOORD_{}", coordinates.set);
  const auto ok =
      read_attribute(part, "POSITION", count, 3, mesh.positions)
          .and_then([&] { return read_attribute(part, "NORMAL", count, 3, mesh.normals); })
          .and_then([&] { return read_attribute(part, set, count, 2, mesh.uvs); })
          .and_then([&] { return read_attribute(part, "COLOR_0", count, 4, mesh.colours); });
  if (coordinates.transform != glm::mat3x2(1.0F)) {
    for (glm::vec2& uv : mesh.uvs)
      uv = coordinates.transform * glm::vec3(uv, 1.0F);
  }
  constexpr float kRounding = 1e-3F;
  const auto is_inside = [](const glm::vec2& uv) {
    return std::max(std::abs(uv.x - 0.5F), std::abs(uv.y - 0.5F)) <= 0.5F + kRounding;
  };
  if (!coordinates.repeats && !std::ranges::all_of(mesh.uvs, is_inside))
    reading.note("has textures that are clamped or mirrored, which are repeated instead");
  return ok;
}

// The corners in the order of the file: its indices, or all vertices.
core::Result<std::vector<std::uint32_t>> read_corners(const Part& part, std::size_t vertices) {
  Reading& reading = part.reading;
  const int accessor = part.described.indices;
  Elements elements;
  if (accessor >= 0 && !part.unpacked) {
    auto found = elements_of(reading, accessor, "indices of " + part.name);
    if (!found) return tl::unexpected(found.error());
    elements = *std::move(found);
    if (elements.width != 1 || elements.component == kFloat || elements.component == kByte ||
        elements.component == kShort)
      return wrong("indices of " + part.name + " are not unsigned integers");
  }
  const std::size_t count = part.unpacked   ? part.unpacked->indices.size()
                            : accessor >= 0 ? elements.count
                                            : vertices;
  const std::size_t each = part.described.mode == kTriangles ? 1 : 3;
  const std::uint64_t most = reading.limits.indices;
  const std::uint64_t wanted = count > most ? count : each * count;  // without overflow
  if (auto ok = add_within_limit(reading.indices, wanted, most, "indices"); !ok)
    return tl::unexpected(ok.error());
  if (part.unpacked) return part.unpacked->indices;
  std::vector<std::uint32_t> corners(count);
  for (std::size_t i = 0; i < count; ++i)
    corners[i] = accessor >= 0 ? elements.whole(i) : static_cast<std::uint32_t>(i);
  return corners;
}

// Three indices per triangle, all counter-clockwise.
std::vector<std::uint32_t> triangles_of(int mode, std::vector<std::uint32_t> corners) {
  if (mode == kTriangles) return corners;
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    if (mode == kTriangleFan) {
      triangles.insert(triangles.end(), {corners[0], corners[i - 1], corners[i]});
    } else {
      const std::size_t odd = i % 2;
      triangles.insert(triangles.end(), {corners[i - 2], corners[i - 1 + odd], corners[i - odd]});
    }
  }
  return triangles;
}

// The mesh that glTF requires if there are no normals: triangles that share no vertices.
MeshData flat(const MeshData& mesh) {
  MeshData out;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const auto triangle = std::span(mesh.indices).subspan(i, 3);
    const glm::vec3 a = mesh.positions[triangle[0]];
    const glm::vec3 across =
        glm::cross(mesh.positions[triangle[1]] - a, mesh.positions[triangle[2]] - a);
    const float length = glm::length(across);
    const glm::vec3 normal = length > 0 ? across / length : glm::vec3(0, 1, 0);
    for (const std::uint32_t vertex : triangle) {
      out.indices.push_back(static_cast<std::uint32_t>(out.positions.size()));
      out.positions.push_back(mesh.positions[vertex]);
      out.normals.push_back(normal);
      if (!mesh.uvs.empty()) out.uvs.push_back(mesh.uvs[vertex]);
      if (!mesh.colours.empty()) out.colours.push_back(mesh.colours[vertex]);
    }
  }
  return out;
}

bool is_direction(const glm::vec3& normal) {
  const float length = glm::length(normal);
  return length > 0 && std::isfinite(length);
}

// Replaces normals that are zero or not finite by the mean of the triangles around them, weighted
// by area. Returns true if there were any.
bool repair_normals(MeshData& mesh) {
  if (std::ranges::all_of(mesh.normals, is_direction)) return false;
  const std::vector<glm::vec3> sums = core::normal_sums(mesh);
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    if (!is_direction(mesh.normals[i]))
      mesh.normals[i] = is_direction(sums[i]) ? glm::normalize(sums[i]) : glm::vec3(0, 1, 0);
  }
  return true;
}

// Decompresses a primitive if it is compressed.
core::Result<void> unpack(Part& part) {
  const PrimitiveJson& described = part.described;
  if (!described.draco) return {};
  const auto position = described.attributes.find("POSITION");
  const auto& accessors = part.reading.file.accessors;
  const bool has_other_bytes =
      position != described.attributes.end() && position->second >= 0 &&
      static_cast<std::size_t>(position->second) < accessors.size() &&
      accessors[static_cast<std::size_t>(position->second)].view != kAbsent;
  if (!kReadsDraco && has_other_bytes) return {};
  auto unpacked = unpack_draco(part.reading, described, part.name);
  if (!unpacked) return tl::unexpected(unpacked.error());
  part.unpacked = std::move(*unpacked);
  return {};
}

core::Result<MeshData> read_mesh(Part& part) {
  MeshData mesh;
  if (auto ok = unpack(part); !ok) return tl::unexpected(ok.error());
  if (auto ok = read_vertices(part, mesh); !ok) return tl::unexpected(ok.error());
  auto corners = read_corners(part, mesh.positions.size());
  if (!corners) return tl::unexpected(corners.error());
  mesh.indices = triangles_of(part.described.mode, std::move(*corners));
  std::vector<glm::vec3> normals = std::move(mesh.normals);
  mesh.normals.clear();
  if (auto ok = core::check(mesh); !ok)
    return wrong(fmt::format("{}: {}", part.name, ok.error().message));
  Reading& reading = part.reading;
  mesh.normals = std::move(normals);
  if (repair_normals(mesh))
    reading.note("has normals of no direction, which are computed from the triangles");
  if (auto ok = core::check(mesh); !ok)
    return wrong(fmt::format("{}: {}", part.name, ok.error().message));
  if (!mesh.normals.empty()) return mesh;
  if (auto ok = add_within_limit(reading.vertices, mesh.indices.size(), reading.limits.vertices,
                                 "vertices");
      !ok)
    return tl::unexpected(ok.error());
  return flat(mesh);
}

core::Result<void> read_primitive(Part& part, Mesh& out) {
  Reading& reading = part.reading;
  const int mode = part.described.mode;
  if (mode < kPoints || mode > kTriangleFan)
    return wrong(fmt::format("{} has the mode {}", part.name, mode));
  if (mode < kTriangles) {
    reading.note("has points or lines, which are ignored");
    return {};
  }
  if (part.described.morphs)
    reading.note("has morph targets, which are not supported; it keeps its base shape");
  Primitive primitive;
  if (part.described.material != kAbsent) {
    const auto material =
        index_in(part.described.material, reading.out.materials.size(), part.name + ".material");
    if (!material) return tl::unexpected(material.error());
    primitive.material = *material;
  }
  auto mesh = read_mesh(part);
  if (!mesh) return tl::unexpected(mesh.error());
  primitive.mesh = std::move(*mesh);
  out.primitives.push_back(std::move(primitive));
  return {};
}

}  // namespace

core::Result<void> read_meshes(Reading& reading) {
  for (std::size_t m = 0; m < reading.file.meshes.size(); ++m) {
    const MeshJson& described = reading.file.meshes[m];
    Mesh mesh;
    mesh.name = described.name;
    for (std::size_t p = 0; p < described.primitives.size(); ++p) {
      Part part{reading, described.primitives[p], fmt::format("meshes[{}].primitives[{}]", m, p)};
      if (auto ok = read_primitive(part, mesh); !ok) return ok;
    }
    reading.out.meshes.push_back(std::move(mesh));
  }
  return {};
}

}  // namespace psygen::gltf
