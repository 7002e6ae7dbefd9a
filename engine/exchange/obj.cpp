#include <fmt/format.h>

#include <iterator>
#include <set>

#include "engine/core/utf8.hpp"
#include "engine/exchange/triangle_colours.hpp"
#include "engine/exchange/write_document.hpp"

namespace psygen::exchange {
namespace {

using Corners = std::array<std::uint32_t, 3>;

// Indices of texture coordinates, from 0, for all triangles in their order.
core::Result<std::vector<Corners>> add_triangles(const Document& document,
                                                 TriangleColours& colours) {
  std::vector<Corners> triangles;
  triangles.reserve(document.triangle_count());
  for (const Object& object : document.objects) {
    for (const Part& part : object.parts) {
      for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
        triangles.push_back(
            colours.add({part.colours[part.indices[i]], part.colours[part.indices[i + 1]],
                         part.colours[part.indices[i + 2]]}));
      }
      if (auto ok = colours.check(); !ok) return tl::unexpected(ok.error());
    }
  }
  return triangles;
}

// Kd is white, because programs multiply it with the image.
std::string mtl_of(const Document& document, const std::string& image_name) {
  std::set<std::uint8_t> materials;
  for (const Object& object : document.objects) {
    for (const Part& part : object.parts)
      materials.insert(part.material);
  }
  std::string text;
  for (const std::uint8_t material : materials) {
    fmt::format_to(std::back_inserter(text), "newmtl {}\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd {}\n",
                   material_name(material), image_name);
  }
  return text += kObjLastLine;
}

void write_coordinates(const TriangleColours& colours, std::string& text) {
  const auto count = static_cast<std::uint32_t>(3 * colours.block_count());
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::dvec2 at = colours.coordinates(i);
    fmt::format_to(std::back_inserter(text), "vt {:.7g} {:.7g}\n", at.x, at.y);
  }
}

void write_vertices(const Object& object, const Part& part, std::string& text) {
  const auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < part.positions.size(); ++i) {
    const glm::vec3 p = part.positions[i] + object.position;
    const glm::vec3 c = srgb(part.colours[i]);
    fmt::format_to(out, "v {} {} {} {:.4f} {:.4f} {:.4f}\n", p.x, p.y, p.z, c.x, c.y, c.z);
  }
  for (const glm::vec3& n : part.normals)
    fmt::format_to(out, "vn {:.5f} {:.5f} {:.5f}\n", n.x, n.y, n.z);
}

// OBJ counts vertices and texture coordinates from 1, over the whole file.
void write_objects(const Document& document, const std::vector<Corners>& coordinates,
                   std::string& text) {
  const auto out = std::back_inserter(text);
  std::uint64_t first = 1;
  std::size_t triangle = 0;
  for (const Object& object : document.objects) {
    fmt::format_to(out, "o {}\n", core::shown(object.name));
    for (const Part& part : object.parts) {
      write_vertices(object, part, text);
      fmt::format_to(out, "usemtl {}\n", material_name(part.material));
      for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
        const std::uint64_t a = first + part.indices[i], b = first + part.indices[i + 1],
                            c = first + part.indices[i + 2];
        const Corners& t = coordinates[triangle++];
        fmt::format_to(out, "f {0}/{3}/{0} {1}/{4}/{1} {2}/{5}/{2}\n", a, b, c, t[0] + 1, t[1] + 1,
                       t[2] + 1);
      }
      first += part.positions.size();
    }
  }
}

}  // namespace

std::string obj_first_line(std::string_view document_name) {
  return fmt::format("# {}: metres, +Y up; colours behind the coordinates are sRGB\n",
                     core::shown(document_name));
}

core::Result<ObjFiles> obj_files(const Document& document, const ObjNames& names) {
  TriangleColours colours;
  const auto coordinates = add_triangles(document, colours);
  if (!coordinates) return tl::unexpected(coordinates.error());
  ObjFiles files{{}, mtl_of(document, names.image), colours.image()};
  files.obj = fmt::format("{}mtllib {}\n", obj_first_line(document.name), names.mtl);
  write_coordinates(colours, files.obj);
  write_objects(document, *coordinates, files.obj);
  files.obj += kObjLastLine;
  return files;
}

}  // namespace psygen::exchange
