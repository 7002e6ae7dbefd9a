// Materials, and the images that they use as colours, normals or light.
#include <fmt/format.h>

#include <map>

#include "engine/gltf/reading.hpp"

namespace psygen::gltf {
namespace {

constexpr double kMaxLight = 1e6;

// Maps the number of an image in the file to its number in Model::images.
using Pictures = std::map<std::uint32_t, std::uint32_t>;

core::Result<image::ImagePtr> decode(const Reading& reading, std::uint32_t number) {
  const tinygltf::Image& described = reading.file.images[number];
  const std::string name = fmt::format("images[{}]", number);
  if (described.bufferView < 0)
    return reading.shared.decode(described.image, name, reading.limits.images);
  return bytes_of_view(reading.file, described.bufferView, name)
      .and_then([&](std::span<const std::uint8_t> bytes) {
        return reading.shared.decode(bytes, name, reading.limits.images);
      });
}

// The number of a texture's image in Model::images. Decodes the image at its first use.
core::Result<std::uint32_t> picture_of(Reading& reading, Pictures& pictures, int texture,
                                       const std::string& what) {
  if (texture == -1) return kNone;
  const auto index = index_in(texture, reading.file.textures.size(), what);
  if (!index) return index;
  const auto number = index_in(reading.file.textures[*index].source, reading.file.images.size(),
                               fmt::format("source of textures[{}]", *index));
  if (!number) return number;
  const auto [at, is_new] =
      pictures.try_emplace(*number, static_cast<std::uint32_t>(reading.out.images.size()));
  if (!is_new) return at->second;
  auto picture = decode(reading, *number);
  if (!picture) return tl::unexpected(picture.error());
  if (auto ok = add_within_limit(reading.pixel_bytes, (*picture)->rgba.size(),
                                 reading.limits.pixel_bytes, "bytes of pixels");
      !ok)
    return tl::unexpected(ok.error());
  reading.out.images.push_back(std::move(*picture));
  return at->second;
}

core::Result<void> read_number(double value, double most, const std::string& what, float& out) {
  if (!(value >= 0 && value <= most))
    return wrong(fmt::format("{} is {}; it must be 0 to {}", what, value, most));
  out = static_cast<float>(value);
  return {};
}

core::Result<void> read_colour(const std::vector<double>& from, const std::string& what,
                               glm::vec3& out) {
  if (from.size() < 3) return wrong(what + " has fewer than three numbers");
  for (int i = 0; i < 3; ++i)
    if (auto ok = read_number(from[static_cast<std::size_t>(i)], 1, what, out[i]); !ok) return ok;
  return {};
}

double emissive_strength(const tinygltf::Material& described) {
  const auto found = described.extensions.find("KHR_materials_emissive_strength");
  if (found == described.extensions.end() || !found->second.Has("emissiveStrength")) return 1;
  const tinygltf::Value& strength = found->second.Get("emissiveStrength");
  return strength.IsNumber() ? strength.GetNumberAsDouble() : 1;
}

core::Result<void> read_numbers(const tinygltf::Material& described, const std::string& name,
                                Reading& reading, Material& out) {
  const std::vector<double>& base = described.pbrMetallicRoughness.baseColorFactor;
  const double normals = described.normalTexture.scale;
  float opacity = 1, strength = 1;
  const auto ok =
      read_colour(base, name + ".baseColorFactor", out.base_colour)
          .and_then([&] {
            const double last = base.size() > 3 ? base[3] : 1;
            return read_number(last, 1, name + ".baseColorFactor", opacity);
          })
          .and_then([&] {
            return read_colour(described.emissiveFactor, name + ".emissiveFactor", out.emissive);
          })
          .and_then([&] {
            return read_number(emissive_strength(described), kMaxLight, name + ".emissiveStrength",
                               strength);
          })
          .and_then([&] {
            return read_number(std::abs(normals), kMaxLight, name + ".normalTexture.scale",
                               out.normal_strength);
          });
  if (!ok) return ok;
  out.emissive *= strength;
  out.normal_strength = static_cast<float>(normals);
  out.two_sided = described.doubleSided;
  if (described.alphaMode == "MASK") {
    out.opacity = opacity;
    return read_number(described.alphaCutoff, kMaxLight, name + ".alphaCutoff", out.min_opacity);
  }
  if (described.alphaMode == "BLEND") {
    reading.note(
        "has blended materials, which are drawn opaque where their opacity is at least one half");
    out.min_opacity = 0.5F;
    out.opacity = opacity;
  } else if (described.alphaMode != "OPAQUE") {
    return wrong(fmt::format("{}.alphaMode must be OPAQUE, MASK or BLEND", name));
  }
  return {};
}

}  // namespace

core::Result<void> read_materials(Reading& reading) {
  Pictures pictures;
  for (std::size_t i = 0; i < reading.file.materials.size(); ++i) {
    const tinygltf::Material& described = reading.file.materials[i];
    const std::string name = fmt::format("materials[{}]", i);
    Material material;
    material.name = described.name;
    if (auto ok = read_numbers(described, name, reading, material); !ok) return ok;
    const tinygltf::TextureInfo& base = described.pbrMetallicRoughness.baseColorTexture;
    const tinygltf::NormalTextureInfo& normal = described.normalTexture;
    const tinygltf::TextureInfo& light = described.emissiveTexture;
    int set = -1;
    const auto use = [&](int texture, int coordinates, const char* what,
                         std::uint32_t& out) -> core::Result<void> {
      const auto picture = picture_of(reading, pictures, texture, name + what);
      if (!picture) return tl::unexpected(picture.error());
      out = *picture;
      if (out == kNone) return {};
      if (set >= 0 && set != coordinates)
        reading.note(
            "has a material whose textures use different coordinates; all of them use "
            "those of its first texture");
      if (set < 0) set = coordinates;
      return {};
    };
    const auto ok =
        use(base.index, base.texCoord, ".baseColorTexture", material.base_texture)
            .and_then([&] {
              return use(normal.index, normal.texCoord, ".normalTexture", material.normal_texture);
            })
            .and_then([&] {
              return use(light.index, light.texCoord, ".emissiveTexture",
                         material.emissive_texture);
            });
    if (!ok) return ok;
    reading.uv_sets.push_back(std::max(set, 0));
    reading.out.materials.push_back(std::move(material));
  }
  return {};
}

}  // namespace psygen::gltf
