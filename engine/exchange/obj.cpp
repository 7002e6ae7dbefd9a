#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <map>

#include "engine/core/utf8.hpp"
#include "engine/exchange/write_document.hpp"

namespace psygen::exchange {
namespace {

// Linear to sRGB (IEC 61966-2-1).
float srgb(float linear) {
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1.0F / 2.4F) - 0.055F;
}

glm::vec3 srgb(const glm::vec3& linear) {
  return {srgb(linear.x), srgb(linear.y), srgb(linear.z)};
}

struct Mean {
  glm::vec3 sum{0.0F};
  float count = 0;
};

std::string mtl_of(const Document& document) {
  std::map<std::uint8_t, Mean> means;
  for (const Object& object : document.objects) {
    for (const Part& part : object.parts) {
      Mean& mean = means[part.material];
      for (const glm::vec3& colour : part.colours)
        mean.sum += colour;
      mean.count += static_cast<float>(part.colours.size());
    }
  }
  std::string text;
  for (const auto& [material, mean] : means) {
    const glm::vec3 colour = mean.sum / std::max(mean.count, 1.0F);
    fmt::format_to(std::back_inserter(text),
                   "newmtl {}\nKd {:.4f} {:.4f} {:.4f}\nKs 0 0 0\nillum 1\n",
                   material_name(material), colour.x, colour.y, colour.z);
  }
  return text += kObjLastLine;
}

}  // namespace

std::string obj_first_line(std::string_view document_name) {
  return fmt::format("# {}: metres, +Y up; colours behind the coordinates are sRGB\n",
                     core::shown(document_name));
}

ObjText obj_text(const Document& document, std::string_view mtl_file_name) {
  ObjText text;
  text.mtl = mtl_of(document);
  const auto out = std::back_inserter(text.obj);
  fmt::format_to(out, "{}mtllib {}\n", obj_first_line(document.name), mtl_file_name);
  std::uint64_t first = 1;  // OBJ counts vertices from 1, over the whole file
  for (const Object& object : document.objects) {
    fmt::format_to(out, "o {}\n", core::shown(object.name));
    for (const Part& part : object.parts) {
      for (std::size_t i = 0; i < part.positions.size(); ++i) {
        const glm::vec3 p = part.positions[i] + object.position;
        const glm::vec3 c = srgb(part.colours[i]);
        fmt::format_to(out, "v {} {} {} {:.4f} {:.4f} {:.4f}\n", p.x, p.y, p.z, c.x, c.y, c.z);
      }
      for (const glm::vec3& n : part.normals)
        fmt::format_to(out, "vn {:.5f} {:.5f} {:.5f}\n", n.x, n.y, n.z);
      fmt::format_to(out, "usemtl {}\n", material_name(part.material));
      for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
        const std::uint64_t a = first + part.indices[i], b = first + part.indices[i + 1],
                            c = first + part.indices[i + 2];
        fmt::format_to(out, "f {0}//{0} {1}//{1} {2}//{2}\n", a, b, c);
      }
      first += part.positions.size();
    }
  }
  text.obj += kObjLastLine;
  return text;
}

}  // namespace psygen::exchange
