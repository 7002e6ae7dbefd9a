#include "engine/gltf/read_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <new>
#include <span>
#include <string_view>
#include <vector>

#include "engine/core/bytes.hpp"
#include "engine/core/out_of_memory.hpp"
#include "engine/core/read_file.hpp"
#include "engine/core/utf8.hpp"
#include "engine/gltf/reading.hpp"

namespace psygen::gltf {
namespace {

using core::ErrorCode;
using Bytes = std::vector<std::uint8_t>;

std::string_view characters(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The parts of a file: its JSON, and its first buffer if it is a .glb.
struct Parts {
  std::string_view json;
  std::span<const std::uint8_t> binary;
};

// Fails with kParse if the lengths in a .glb contradict each other.
core::Result<Parts> parts_of(const Bytes& bytes) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8;
  constexpr std::uint32_t kJson = 0x4E4F534A, kBinary = 0x004E4942;
  if (bytes.empty()) return wrong("the file is empty");
  const std::string_view text = characters(bytes);
  if (!text.starts_with("glTF")) return Parts{text, {}};
  if (bytes.size() < kHeader + kChunkHeader)
    return wrong("is not glTF that can be read: too short");
  std::uint32_t magic = 0, version = 0, length = 0;
  core::ByteReader(text).read(magic, version, length);
  if (version != 2)
    return wrong(fmt::format("is a .glb of version {}; only version 2 is supported", version));
  if (length > bytes.size())
    return wrong(
        fmt::format("the file is cut short: it has {} of its {} bytes", bytes.size(), length));
  Parts parts;
  core::ByteReader chunks(text.substr(0, length).substr(std::min<std::size_t>(length, kHeader)));
  for (std::size_t chunk = 0; chunks.left() >= kChunkHeader; ++chunk) {
    std::uint32_t size = 0, type = 0;
    chunks.read(size, type);
    if (size > chunks.left())
      return wrong(
          fmt::format("is not glTF that can be read: its part {} has {} bytes, but {} are "
                      "left",
                      chunk, size, chunks.left()));
    const std::string_view content = chunks.get_text(size);
    if (chunk == 0 && type != kJson) return wrong("is not glTF that can be read: it has no JSON");
    if (chunk == 0) parts.json = content;
    if (chunk == 1 && type == kBinary)
      parts.binary = {reinterpret_cast<const std::uint8_t*>(content.data()), content.size()};
  }
  return parts;
}

// The extensions of glTF that the reader supports, or notes where they are used.
constexpr std::string_view kSupported[]{"EXT_meshopt_compression",
                                        "EXT_texture_webp",
                                        "KHR_animation_pointer",
                                        "KHR_draco_mesh_compression",
                                        "KHR_materials_emissive_strength",
                                        "KHR_mesh_quantization",
                                        "KHR_texture_transform"};
// Those that change light, or add what is no triangle: the rest is drawn without them.
constexpr std::string_view kOptional[]{"KHR_lights_punctual", "KHR_xmp_json_ld",
                                       "KHR_node_visibility", "EXT_lights_image_based"};

bool is_supported(std::string_view extension) {
  return std::ranges::find(kSupported, extension) != std::end(kSupported);
}

bool is_optional(std::string_view extension) {
  return extension.starts_with("KHR_materials_") ||
         std::ranges::find(kOptional, extension) != std::end(kOptional);
}

core::Result<void> check_version(const Document& file) {
  const bool is_later = !file.min_version.empty() && file.min_version != "2.0";
  if (!file.version.starts_with("2.") || is_later)
    return core::fail(
        ErrorCode::kParse,
        fmt::format("is glTF of version \"{}\"; only version 2 is supported",
                    core::shown(is_later ? file.min_version : file.version, kMaxMessage)));
  for (const std::string& name : file.extensions_required) {
    if (!is_supported(name) && !is_optional(name))
      return core::invalid_argument(fmt::format(
          "requires the extension \"{}\", which is not supported", core::shown(name, kMaxMessage)));
  }
  return {};
}

// Notes the extensions that are left out.
void note_extensions(Reading& reading) {
  for (const auto* names : {&reading.file.extensions_used, &reading.file.extensions_required}) {
    for (const std::string& name : *names) {
      if (name == "KHR_materials_pbrSpecularGlossiness")
        reading.note("has materials of the extension \"" + name +
                     "\", of which the diffuse colour is drawn");
      else if (!is_supported(name))
        reading.note(
            fmt::format("uses the extension \"{}\", which is ignored", core::shown(name, 100)));
    }
  }
}

// glTF itself needs seven; the rest is for program data in "extras".
constexpr std::uint32_t kMaxDepth = 64;

// The position after a string that begins at `at`.
std::size_t behind_string(std::string_view json, std::size_t at) {
  for (++at; at < json.size() && json[at] != '"'; ++at)
    at += json[at] == '\\' ? 1 : 0;
  return at + 1;
}

// Rejects JSON that is far larger in memory than as text: endlessly nested lists, and millions of
// small values. Text that is not JSON passes. Fails with kOverBudget; the message does not name the
// file. O(characters).
core::Result<void> check_shape(std::string_view json, std::uint32_t max_values) {
  std::uint32_t depth = 0, values = 0;
  for (std::size_t at = 0; at < json.size();) {
    const char c = json[at];
    if (c == '"') {
      at = behind_string(json, at);
      continue;
    }
    ++at;
    if ((c == ']' || c == '}') && depth > 0) --depth;
    if (c == ',') ++values;
    if (c != '[' && c != '{') continue;
    ++values;
    if (++depth > kMaxDepth) {
      return core::fail(ErrorCode::kOverBudget,
                        fmt::format("its JSON is nested more than {} levels deep at character {}",
                                    kMaxDepth, at));
    }
    if (values > max_values) break;
  }
  if (values <= max_values) return {};
  return core::fail(ErrorCode::kOverBudget,
                    fmt::format("its JSON has more than {} values", max_values));
}

// Bytes that a file and the files that it names may have.
std::uint64_t max_bytes_of(const Limits& limits) {
  return std::min<std::uint64_t>(limits.bytes, INT32_MAX);
}

core::Result<Model> read(const std::filesystem::path& path, const Bytes& bytes,
                         const Limits& limits, image::ImageCache& shared) {
  const auto parts = parts_of(bytes);
  if (!parts) return tl::unexpected(parts.error());
  if (auto ok = check_shape(parts->json, limits.json_values); !ok)
    return tl::unexpected(ok.error());
  const auto file = parse_document(parts->json);
  if (!file) return tl::unexpected(file.error());
  if (auto ok = check_version(*file); !ok) return tl::unexpected(ok.error());
  Model model;
  model.name = path.filename().string();
  Source source(path, *file, parts->binary, model, max_bytes_of(limits) - bytes.size());
  Reading reading{
      .file = *file, .limits = limits, .out = model, .shared = shared, .source = source};
  note_extensions(reading);
  const auto ok = read_materials(reading)
                      .and_then([&] { return read_meshes(reading); })
                      .and_then([&] { return read_nodes(reading); })
                      .and_then([&] { return read_animations(reading); });
  if (!ok) return tl::unexpected(ok.error());
  for (const std::string& uri : source.unused_missing())
    reading.note(fmt::format("names the file \"{}\", which is missing; nothing uses it",
                             core::shown(uri, kMaxMessage)));
  bool visible = false;
  for (const Node& node : model.nodes)
    visible = visible || (node.mesh != kNone && !model.meshes[node.mesh].primitives.empty());
  if (!visible) return wrong("its scene has no triangles");
  for (std::string& note : model.notes)
    note = fmt::format("{}: {}", path.string(), note);
  return model;
}

}  // namespace

core::Result<Model> read_file(const std::filesystem::path& path, const Limits& limits,
                              image::ImageCache* shared) {
  try {
    image::ImageCache own(0);
    const auto bytes = core::read_file(path, max_bytes_of(limits));
    if (!bytes) return tl::unexpected(bytes.error());
    auto model = read(path, *bytes, limits, shared != nullptr ? *shared : own);
    if (!model)
      return core::fail(model.error().code,
                        fmt::format("{}: {}", path.string(), model.error().message));
    return model;
  } catch (const std::bad_alloc&) {
    return core::fail(ErrorCode::kOutOfMemory, core::out_of_memory(path.string()));
  } catch (const std::exception& error) {
    return core::fail(ErrorCode::kParse,
                      fmt::format("{}: is not glTF that can be read: {}", path.string(),
                                  core::shown(error.what(), kMaxMessage)));
  }
}

}  // namespace psygen::gltf
