// Meshes: lists of vertices, and triangles of lists, strips and fans.
#include <fmt/format.h>

#include <glm/geometric.hpp>

#include "engine/gltf/reading.hpp"

namespace psygen::gltf {
namespace {

using core::MeshData;

// One primitive that is being read.
struct Part {
  Reading& reading;
  const tinygltf::Primitive& described;
  std::string name;  // "meshes[0].primitives[0]"
};

// The elements of an attribute. `first` is null if the primitive has none of this name.
core::Result<Elements> attribute(const Part& part, const std::string& which, std::size_t count,
                                 int min_width, int max_width) {
  const auto found = part.described.attributes.find(which);
  if (found == part.described.attributes.end()) return Elements{};
  const std::string what = which + " of " + part.name;
  auto elements = elements_of(part.reading.file, found->second, what);
  if (!elements) return elements;
  if (elements->width < min_width || elements->width > max_width)
    return wrong(fmt::format("{} has {} components", what, elements->width));
  if (count != SIZE_MAX && elements->count != count)
    return wrong(fmt::format("{} has {} elements for {} vertices", what, elements->count, count));
  return elements;
}

template <class Vector>
core::Result<void> read_attribute(const Part& part, const std::string& which, std::size_t count,
                                  int max_width, std::vector<Vector>& out) {
  const auto elements = attribute(part, which, count, Vector::length(), max_width);
  if (!elements) return tl::unexpected(elements.error());
  if (elements->first == nullptr) return {};
  out.reserve(elements->count);
  for (std::size_t i = 0; i < elements->count; ++i)
    out.push_back(vector_of<Vector>(*elements, i));
  return {};
}

core::Result<void> read_vertices(const Part& part, MeshData& mesh) {
  Reading& reading = part.reading;
  const auto positions = attribute(part, "POSITION", SIZE_MAX, 3, 3);
  if (!positions) return tl::unexpected(positions.error());
  if (positions->first == nullptr) return wrong(part.name + " has no POSITION");
  const std::size_t count = positions->count;
  if (auto ok = add_within_limit(reading.vertices, count, reading.limits.vertices, "vertices"); !ok)
    return ok;
  const int material = part.described.material;
  const int set = material < 0 ? 0 : reading.uv_sets[static_cast<std::size_t>(material)];
  return read_attribute(part, "POSITION", count, 3, mesh.positions)
      .and_then([&] { return read_attribute(part, "NORMAL", count, 3, mesh.normals); })
      .and_then(
          [&] { return read_attribute(part, fmt::format("TEXCOORD_{}", set), count, 2, mesh.uvs); })
      .and_then([&] { return read_attribute(part, "COLOR_0", count, 4, mesh.colours); });
}

// The corners in the order of the file: its indices, or all vertices.
core::Result<std::vector<std::uint32_t>> read_corners(const Part& part, std::size_t vertices) {
  Reading& reading = part.reading;
  const int accessor = part.described.indices;
  Elements elements;
  if (accessor >= 0) {
    auto found = elements_of(reading.file, accessor, "indices of " + part.name);
    if (!found) return tl::unexpected(found.error());
    elements = *found;
    if (elements.width != 1 || elements.component == TINYGLTF_COMPONENT_TYPE_FLOAT ||
        elements.component == TINYGLTF_COMPONENT_TYPE_BYTE ||
        elements.component == TINYGLTF_COMPONENT_TYPE_SHORT)
      return wrong("indices of " + part.name + " are not unsigned integers");
  }
  const std::size_t count = accessor >= 0 ? elements.count : vertices;
  const std::size_t each = part.described.mode == TINYGLTF_MODE_TRIANGLES ? 1 : 3;
  if (auto ok = add_within_limit(reading.indices, each * count, reading.limits.indices, "indices");
      !ok)
    return tl::unexpected(ok.error());
  std::vector<std::uint32_t> corners(count);
  for (std::size_t i = 0; i < count; ++i)
    corners[i] = accessor >= 0 ? elements.whole(i) : static_cast<std::uint32_t>(i);
  return corners;
}

// Three indices per triangle, all counter-clockwise.
std::vector<std::uint32_t> triangles_of(int mode, std::vector<std::uint32_t> corners) {
  if (mode == TINYGLTF_MODE_TRIANGLES) return corners;
  std::vector<std::uint32_t> triangles;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
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
  for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
    const std::uint32_t vertex = mesh.indices[i], *triangle = &mesh.indices[i / 3 * 3];
    const glm::vec3 a = mesh.positions[triangle[0]];
    const glm::vec3 across =
        glm::cross(mesh.positions[triangle[1]] - a, mesh.positions[triangle[2]] - a);
    const float length = glm::length(across);
    out.positions.push_back(mesh.positions[vertex]);
    out.normals.push_back(length > 0 ? across / length : glm::vec3(0, 1, 0));
    if (!mesh.uvs.empty()) out.uvs.push_back(mesh.uvs[vertex]);
    if (!mesh.colours.empty()) out.colours.push_back(mesh.colours[vertex]);
    out.indices.push_back(static_cast<std::uint32_t>(i));
  }
  return out;
}

core::Result<MeshData> read_mesh(const Part& part) {
  MeshData mesh;
  if (auto ok = read_vertices(part, mesh); !ok) return tl::unexpected(ok.error());
  auto corners = read_corners(part, mesh.positions.size());
  if (!corners) return tl::unexpected(corners.error());
  mesh.indices = triangles_of(part.described.mode, std::move(*corners));
  if (auto ok = core::check(mesh); !ok)
    return wrong(fmt::format("{}: {}", part.name, ok.error().message));
  if (!mesh.normals.empty()) return mesh;
  Reading& reading = part.reading;
  if (auto ok = add_within_limit(reading.vertices, mesh.indices.size(), reading.limits.vertices,
                                 "vertices");
      !ok)
    return tl::unexpected(ok.error());
  return flat(mesh);
}

core::Result<void> read_primitive(const Part& part, Mesh& out) {
  Reading& reading = part.reading;
  const int mode = part.described.mode;
  if (mode < TINYGLTF_MODE_POINTS || mode > TINYGLTF_MODE_TRIANGLE_FAN)
    return wrong(fmt::format("{} has the mode {}", part.name, mode));
  if (mode < TINYGLTF_MODE_TRIANGLES) {
    reading.note("has points or lines, which are ignored");
    return {};
  }
  if (!part.described.targets.empty())
    reading.note("has morph targets, which are not supported; it keeps its base shape");
  Primitive primitive;
  if (part.described.material != -1) {
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
    const tinygltf::Mesh& described = reading.file.meshes[m];
    Mesh mesh;
    mesh.name = described.name;
    for (std::size_t p = 0; p < described.primitives.size(); ++p) {
      const Part part{reading, described.primitives[p],
                      fmt::format("meshes[{}].primitives[{}]", m, p)};
      if (auto ok = read_primitive(part, mesh); !ok) return ok;
    }
    reading.out.meshes.push_back(std::move(mesh));
  }
  return {};
}

}  // namespace psygen::gltf
