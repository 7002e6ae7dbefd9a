#include "engine/gltf/read_file.hpp"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <utility>
#include <vector>

#include "engine/core/out_of_memory.hpp"
#include "engine/core/utf8.hpp"
#include "engine/gltf/parse.hpp"
#include "engine/gltf/reading.hpp"

namespace psygen::gltf {
namespace {

core::Result<Model> read_parsed(const std::filesystem::path& path, const tinygltf::Model& file,
                                const Limits& limits) {
  Model model;
  model.name = path.filename().string();
  Reading reading{.file = file, .limits = limits, .out = model, .uv_sets = {}, .node_numbers = {}};
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

core::Result<Model> read_file(const std::filesystem::path& path, const Limits& limits) {
  try {
    std::vector<std::filesystem::path> named;
    const auto file = parse(path, limits, named);
    if (!file) return tl::unexpected(file.error());
    auto model = read_parsed(path, *file, limits);
    if (!model) {
      return core::fail(model.error().code,
                        fmt::format("{}: {}", path.string(), model.error().message));
    }
    model->files = std::move(named);
    return model;
  } catch (const std::bad_alloc&) {
    return core::fail(core::ErrorCode::kOutOfMemory, core::out_of_memory(path.string()));
  } catch (const std::exception& error) {
    return core::fail(core::ErrorCode::kParse,
                      fmt::format("{}: is not glTF that can be read: {}", path.string(),
                                  core::shown(error.what(), 300)));
  }
}

}  // namespace psygen::gltf
