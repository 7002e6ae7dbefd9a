// Materials, and the images that they use as colours, normals or light.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>

#include "engine/core/utf8.hpp"
#include "engine/gltf/reading.hpp"

namespace psygen::gltf {
namespace {

constexpr double kMaxLight = 1e6;

// The number of an image in Model::images, or its error.
struct Picture {
  core::Result<std::uint32_t> number;
  bool is_missing = false;  // its file does not exist
};
using Pictures = std::map<std::uint32_t, Picture>;  // by the number of the image in the file

core::Result<image::ImagePtr> decode(Reading& reading, std::uint32_t number) {
  const ImageJson& described = reading.file.images[number];
  const std::string name = fmt::format("images[{}]", number);
  if (described.view == kAbsent && described.uri.empty())
    return wrong(name + " has neither a bufferView nor a uri");
  if (described.view == kAbsent)
    return reading.source.of_uri(described.uri).and_then([&](const Source::Bytes& bytes) {
      return reading.shared.decode(bytes, name, reading.limits.images);
    });
  return reading.source.of_view(described.view, name).and_then([&](Source::View bytes) {
    return reading.shared.decode(bytes, name, reading.limits.images);
  });
}

// Decodes the image at its first use.
Picture image_of(Reading& reading, Pictures& pictures, int source, const std::string& texture) {
  const auto number = index_in(source, reading.file.images.size(), "source of " + texture);
  if (!number) return {number};
  if (const auto known = pictures.find(*number); known != pictures.end()) return known->second;
  const auto add = [&](image::ImagePtr picture) -> core::Result<std::uint32_t> {
    if (auto ok = add_within_limit(reading.pixel_bytes, picture->rgba.size(),
                                   reading.limits.pixel_bytes, "bytes of pixels");
        !ok)
      return tl::unexpected(ok.error());
    reading.out.images.push_back(std::move(picture));
    return static_cast<std::uint32_t>(reading.out.images.size() - 1);
  };
  const std::size_t missing = reading.out.missing.size();
  auto made = decode(reading, *number).and_then(add);
  const bool is_missing = !made && reading.out.missing.size() > missing;
  return pictures.emplace(*number, Picture{std::move(made), is_missing}).first->second;
}

// The number of a texture's image in Model::images; kNone if there is none, or its file does not
// exist. `user` names the material.
core::Result<std::uint32_t> picture_of(Reading& reading, Pictures& pictures, int texture,
                                       const std::string& what, const std::string& user) {
  if (texture == kAbsent) return kNone;
  const auto index = index_in(texture, reading.file.textures.size(), what);
  if (!index) return index;
  const TextureJson& described = reading.file.textures[*index];
  const std::string name = fmt::format("textures[{}]", *index);
  std::string reason = name + " has no image";
  if (!described.other_extension.empty())
    reason = fmt::format("{} has its image in the extension \"{}\", which is not supported", name,
                         core::shown(described.other_extension, 100));
  for (const bool webp : {true, false}) {
    const int source = webp ? described.webp : described.source;
    if (source == kAbsent) continue;
    const auto [picture, is_missing] = image_of(reading, pictures, source, name);
    if (picture) return picture;
    const auto [code, message] = picture.error();
    const bool is_optional = webp && code == core::ErrorCode::kParse;
    if (!is_missing && !is_optional) return picture;
    reason = webp ? "EXT_texture_webp: " + message : message;
  }
  reading.note(fmt::format("{} is drawn without an image: {}", user, reason));
  return kNone;
}

core::Result<void> read_number(double value, double most, const std::string& what, float& out) {
  if (!(value >= 0 && value <= most))
    return wrong(fmt::format("{} is {}; it must be 0 to {}", what, value, most));
  out = static_cast<float>(value);
  return {};
}

// `out` keeps its value if the file has none.
core::Result<void> read_colour(const std::vector<double>& from, const std::string& what,
                               glm::vec3& out) {
  if (from.empty()) return {};
  if (from.size() < 3) return wrong(what + " has fewer than three numbers");
  for (int i = 0; i < 3; ++i)
    if (auto ok = read_number(from[static_cast<std::size_t>(i)], 1, what, out[i]); !ok) return ok;
  return {};
}

constexpr double kMaxOfTransform = 1e6;

// KHR_texture_transform as a matrix: scale, then rotation, then offset. A positive rotation turns
// counter-clockwise, with v down.
core::Result<Coordinates> coordinates_of(const Document& file, const TextureUseJson& use,
                                         const std::string& what) {
  double offset[2] = {0, 0}, scale[2] = {1, 1};
  const auto read = [&](const std::vector<double>& from, double(&to)[2]) {
    if (from.empty()) return true;
    if (from.size() != 2) return false;
    to[0] = from[0], to[1] = from[1];
    return std::abs(to[0]) <= kMaxOfTransform && std::abs(to[1]) <= kMaxOfTransform;
  };
  if (use.set < 0) return wrong(fmt::format("{}.texCoord is {}", what, use.set));
  if (!read(use.offset, offset) || !read(use.scale, scale) ||
      !(std::abs(use.rotation) <= kMaxOfTransform))
    return wrong(fmt::format("KHR_texture_transform of {} needs pairs of numbers of at most {}",
                             what, kMaxOfTransform));
  const double c = std::cos(use.rotation), s = std::sin(use.rotation);
  Coordinates out{use.set, glm::mat3x2(c * scale[0], -s * scale[0], s * scale[1], c * scale[1],
                                       offset[0], offset[1])};
  const int sampler = file.textures[static_cast<std::size_t>(use.texture)].sampler;
  if (sampler == kAbsent) return out;
  const auto index = index_in(sampler, file.samplers.size(), "sampler of " + what);
  if (!index) return tl::unexpected(index.error());
  out.repeats = file.samplers[*index];
  return out;
}

core::Result<void> read_numbers(const MaterialJson& described, const std::string& name,
                                Reading& reading, Material& out) {
  const std::vector<double>& base = described.base_colour;
  const double normals = described.normal.strength;
  float opacity = 1, strength = 1;
  const auto ok =
      read_colour(base, name + ".baseColorFactor", out.base_colour)
          .and_then([&] {
            const double last = base.size() > 3 ? base[3] : 1;
            return read_number(last, 1, name + ".baseColorFactor", opacity);
          })
          .and_then([&] {
            return read_colour(described.emissive, name + ".emissiveFactor", out.emissive);
          })
          .and_then([&] {
            return read_number(described.emissive_strength, kMaxLight, name + ".emissiveStrength",
                               strength);
          })
          .and_then([&] {
            return read_number(std::abs(normals), kMaxLight, name + ".normalTexture.scale",
                               out.normal_strength);
          });
  if (!ok) return ok;
  out.emissive *= strength;
  out.normal_strength = static_cast<float>(normals);
  out.two_sided = described.two_sided;
  if (described.alpha_mode == "MASK") {
    out.opacity = opacity;
    return read_number(described.alpha_cutoff, kMaxLight, name + ".alphaCutoff", out.min_opacity);
  }
  if (described.alpha_mode == "BLEND") {
    reading.note(
        "has blended materials, which are drawn opaque where their opacity is at least one half");
    out.min_opacity = 0.5F;
    out.opacity = opacity;
  } else if (described.alpha_mode != "OPAQUE") {
    return wrong(fmt::format("{}.alphaMode must be OPAQUE, MASK or BLEND", name));
  }
  return {};
}

}  // namespace

core::Result<void> read_materials(Reading& reading) {
  Pictures pictures;
  for (std::size_t i = 0; i < reading.file.materials.size(); ++i) {
    const MaterialJson& described = reading.file.materials[i];
    const std::string name = fmt::format("materials[{}]", i);
    const std::string user = described.name.empty()
                                 ? name
                                 : fmt::format("{} \"{}\"", name, core::shown(described.name, 100));
    Material material;
    material.name = described.name;
    if (auto ok = read_numbers(described, name, reading, material); !ok) return ok;
    std::optional<Coordinates> first;
    const auto use = [&](const TextureUseJson& of, const char* what,
                         std::uint32_t& out) -> core::Result<void> {
      const auto picture = picture_of(reading, pictures, of.texture, name + what, user);
      if (!picture) return tl::unexpected(picture.error());
      out = *picture;
      if (out == kNone) return {};
      const auto own = coordinates_of(reading.file, of, name + what);
      if (!own) return tl::unexpected(own.error());
      if (first && (first->set != own->set || first->transform != own->transform))
        reading.note(
            "has a material whose textures use different coordinates; all of them use "
            "those of its first texture");
      if (!first) first = *own;
      return {};
    };
    const auto ok =
        use(described.base, ".baseColorTexture", material.base_texture)
            .and_then(
                [&] { return use(described.normal, ".normalTexture", material.normal_texture); })
            .and_then([&] {
              return use(described.light, ".emissiveTexture", material.emissive_texture);
            });
    if (!ok) return ok;
    reading.coordinates.push_back(first.value_or(Coordinates{}));
    reading.out.materials.push_back(std::move(material));
  }
  return {};
}

}  // namespace psygen::gltf
