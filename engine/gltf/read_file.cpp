#include "engine/gltf/read_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/core/out_of_memory.hpp"
#include "engine/core/read_file.hpp"
#include "engine/core/utf8.hpp"
#include "engine/gltf/reading.hpp"

namespace psygen::gltf {
namespace {

using core::ErrorCode;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kMaxMessage = 300;  // length of a library's message

// The only access of TinyGLTF to files. The library needs function pointers.
struct FileGate {
  std::filesystem::path file;
  std::uint64_t left_bytes = 0;
  std::vector<std::filesystem::path>& named;  // the files that were read
  std::optional<core::Error> error;           // the first error
};

core::Result<std::filesystem::path> beside(const std::filesystem::path& file,
                                           const std::filesystem::path& name) {
  const auto refuse = [&] {
    return core::invalid_argument(
        fmt::format("names the file \"{}\"; only files in its own folder are read",
                    core::shown(name.string(), kMaxMessage)));
  };
  const std::string& text = name.native();
  const bool has_scheme = text.find(':') != std::string::npos;
  if (text.empty() || text.find('\0') != std::string::npos || name.is_absolute() || has_scheme ||
      std::ranges::find(name, "..") != name.end())
    return refuse();
  std::error_code error;
  const auto folder = std::filesystem::weakly_canonical(file.parent_path() / ".", error);
  const auto target = std::filesystem::weakly_canonical(folder / name, error);
  if (error) return core::fail(ErrorCode::kIo, error.message());
  const auto [end, ignored] = std::ranges::mismatch(folder, target);
  const bool inside = end == folder.end() || end->empty();
  if (!inside) return refuse();
  return target;
}

bool read_beside(std::vector<unsigned char>* out, std::string* message, const std::string& name,
                 void* user) {
  FileGate& gate = *static_cast<FileGate*>(user);
  auto bytes = beside(gate.file, name).and_then([&](const std::filesystem::path& path) {
    gate.named.push_back(gate.file.parent_path() / name);
    return core::read_file(path, gate.left_bytes);
  });
  if (!bytes) {
    if (!gate.error) gate.error = bytes.error();
    *message = "see above";
    return false;
  }
  gate.left_bytes -= bytes->size();
  *out = std::move(*bytes);
  return true;
}

std::string_view characters(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The JSON in a file. Empty if a .glb is too short for it; TinyGLTF then rejects it.
std::string_view json_of(const Bytes& bytes, bool binary) {
  constexpr std::size_t kHeader = 20, kLengthAt = 12;
  if (!binary) return characters(bytes);
  if (bytes.size() < kHeader) return {};
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + kLengthAt, sizeof length);
  return characters(bytes).substr(kHeader, length);
}

// True if the reader supports this extension of glTF.
bool is_supported(std::string_view extension) {
  return extension == "KHR_materials_emissive_strength" || extension == "KHR_mesh_quantization";
}

core::Result<void> check_version(const tinygltf::Model& model) {
  if (!model.asset.version.starts_with("2.")) {
    return core::fail(ErrorCode::kParse,
                      fmt::format("is glTF of version \"{}\"; only version 2 is supported",
                                  core::shown(model.asset.version, kMaxMessage)));
  }
  for (const std::string& name : model.extensionsRequired) {
    if (!is_supported(name)) {
      return core::invalid_argument(fmt::format(
          "requires the extension \"{}\", which is not supported", core::shown(name, kMaxMessage)));
    }
  }
  return {};
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

// Compares the length with the header of a .glb.
core::Result<void> check_length(const Bytes& bytes, bool binary) {
  if (bytes.empty()) return core::fail(ErrorCode::kParse, "the file is empty");
  if (!binary || bytes.size() < 12) return {};
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 8, sizeof(length));
  if (length <= bytes.size()) return {};
  return core::fail(
      ErrorCode::kParse,
      fmt::format("the file is cut short: it has {} of its {} bytes", bytes.size(), length));
}

// The first line of a library's message.
std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

// Bytes that a file and the files that it names may have. TinyGLTF counts them as int.
std::uint64_t max_bytes_of(const Limits& limits) {
  return std::min<std::uint64_t>(limits.bytes, INT32_MAX);
}

// Parses the JSON and the bytes of a file with TinyGLTF. Indices in the result are not checked, and
// images are not decoded: the member `image` of an image with a URI has the bytes of its file.
// Appends the files that it names to `named`. Fails like read_file(). Throws std::bad_alloc and
// exceptions of TinyGLTF.
core::Result<tinygltf::Model> parse(const std::filesystem::path& path, const Bytes& bytes,
                                    const Limits& limits,
                                    std::vector<std::filesystem::path>& named) {
  const bool binary = characters(bytes).starts_with("glTF");
  if (auto ok = check_length(bytes, binary); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_shape(json_of(bytes, binary), limits.json_values); !ok)
    return tl::unexpected(ok.error());

  FileGate gate{path, max_bytes_of(limits) - bytes.size(), named, {}};
  tinygltf::TinyGLTF reader;
  tinygltf::FsCallbacks files{};
  files.FileExists = [](const std::string&, void*) { return true; };
  files.ExpandFilePath = [](const std::string& name, void*) { return name; };
  files.ReadWholeFile = read_beside;
  files.user_data = &gate;
  reader.SetFsCallbacks(files);
  // Keeps the encoded bytes of an image that is not in a buffer. The `encoded` of an image in a
  // buffer may be out of its range.
  reader.SetImageLoader(
      [](tinygltf::Image* image, int, std::string*, std::string*, int, int,
         const unsigned char* encoded, int length, void*) {
        if (image->bufferView < 0) image->image.assign(encoded, encoded + length);
        return true;
      },
      nullptr);

  tinygltf::Model model;
  std::string errors, warnings;
  const auto size = static_cast<unsigned>(bytes.size());
  const bool parsed =
      binary ? reader.LoadBinaryFromMemory(&model, &errors, &warnings, bytes.data(), size)
             : reader.LoadASCIIFromString(&model, &errors, &warnings, characters(bytes).data(),
                                          size, "");
  if (gate.error) return tl::unexpected(*gate.error);
  // TinyGLTF continues after many errors and loses the faulty parts. This message is no error in
  // glTF 2.0.
  constexpr std::string_view kNoError = "'inverseBindMatrices' property is missing in Skin.\n";
  for (std::size_t at = errors.find(kNoError); at != std::string::npos; at = errors.find(kNoError))
    errors.erase(at, kNoError.size());
  if (!parsed || !errors.empty())
    return core::fail(ErrorCode::kParse, "is not glTF that can be read: " +
                                             core::shown(first_line(errors), kMaxMessage));
  if (auto ok = check_version(model); !ok) return tl::unexpected(ok.error());
  return model;
}

core::Result<Model> read_parsed(const std::filesystem::path& path, const tinygltf::Model& file,
                                const Limits& limits, image::ImageCache* shared) {
  Model model;
  model.name = path.filename().string();
  image::ImageCache own(0);
  Reading reading{.file = file,
                  .limits = limits,
                  .out = model,
                  .shared = shared != nullptr ? *shared : own,
                  .uv_sets = {},
                  .node_numbers = {}};
  for (const std::string& name : file.extensionsUsed) {
    if (!is_supported(name))
      reading.note(
          fmt::format("uses the extension \"{}\", which is ignored", core::shown(name, 100)));
  }
  const auto ok = read_materials(reading)
                      .and_then([&] { return read_meshes(reading); })
                      .and_then([&] { return read_nodes(reading); })
                      .and_then([&] { return read_animations(reading); });
  if (!ok) return tl::unexpected(ok.error());
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
    std::vector<std::filesystem::path> named;
    const auto bytes = core::read_file(path, max_bytes_of(limits));
    if (!bytes) return tl::unexpected(bytes.error());
    auto model = parse(path, *bytes, limits, named).and_then([&](const tinygltf::Model& file) {
      return read_parsed(path, file, limits, shared);
    });
    if (!model)
      return core::fail(model.error().code,
                        fmt::format("{}: {}", path.string(), model.error().message));
    model->files = std::move(named);
    return model;
  } catch (const std::bad_alloc&) {
    return core::fail(ErrorCode::kOutOfMemory, core::out_of_memory(path.string()));
  } catch (const std::exception& error) {
    return core::fail(ErrorCode::kParse,
                      fmt::format("{}: is not glTF that can be read: {}", path.string(),
                                  core::shown(error.what(), 300)));
  }
}

}  // namespace psygen::gltf
