#include "editor/pictures/export_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/amplify/block_files.hpp"
#include "engine/exchange/unpack.hpp"
#include "engine/exchange/write_document.hpp"
#include "engine/synthesis/synthesise.hpp"
#include "engine/world/placement.hpp"

namespace psygen::editor {
namespace {

tl::unexpected<core::Error> invalid_export(std::string message) {
  return core::fail(core::ErrorCode::kInvalidArgument, std::move(message));
}

core::Result<std::string> written(const core::Result<exchange::Document>& document,
                                  const std::filesystem::path& file) {
  if (!document) return tl::unexpected(document.error());
  const std::string ending = file.extension().string();
  const auto format = exchange::format_from(ending.empty() ? "" : ending.substr(1));
  if (!format)
    return invalid_export(fmt::format("{}: the name must end in .glb or .obj", file.string()));
  if (auto ok = exchange::write_scene(file, *format, *document); !ok)
    return tl::unexpected(ok.error());
  const std::size_t objects = document->objects.size();
  return fmt::format("{} object{}, {} vertices, {} triangles", objects, objects == 1 ? "" : "s",
                     document->vertex_count(), document->triangle_count());
}

core::Result<exchange::Document> model_document(const ParsedWorld& parsed,
                                                const world::Placement& placed, int level) {
  const models::ModelType& type = parsed.registry[placed.model];
  level = std::clamp(level, 0, type.level_count() - 1);
  const auto mesh = synthesis::HeapDestination::make(type, placed.parameters, level);
  if (!mesh) return tl::unexpected(mesh.error());
  const auto outcome = synthesis::synthesise_guarded(type, placed.parameters, level, mesh->view());
  if (!outcome.ok) return core::fail(core::ErrorCode::kSynthesisFailed, outcome.error);
  auto object = exchange::unpack(type, placed.parameters, level, mesh->size(), mesh->view(),
                                 world::drawn_palette(parsed.world));
  if (!object) return tl::unexpected(object.error());
  exchange::Document document{std::string(type.name()), {}};
  document.objects.push_back(std::move(*object));
  return document;
}

}  // namespace

core::Result<std::string> export_block(const ParsedWorld& parsed, core::BlockCoord block, int level,
                                       const std::filesystem::path& file) {
  if (!parsed.world.contains(block))
    return invalid_export(fmt::format("block {},{} is outside the world", block.x, block.z));
  return written(amplify::block_document(parsed.world, parsed.registry, block, level), file);
}

core::Result<std::string> export_model(const ParsedWorld& parsed, core::BlockCoord block,
                                       std::uint32_t index, int level,
                                       const std::filesystem::path& file) {
  if (!parsed.world.contains(block))
    return invalid_export(fmt::format("block {},{} is outside the world", block.x, block.z));
  std::vector<world::Placement> placements;
  world::place_models(parsed.world, parsed.registry, block, placements);
  const auto placed = std::ranges::find(placements, index, &world::Placement::index);
  if (placed == placements.end())
    return invalid_export(fmt::format("block {},{} has no model {}", block.x, block.z, index));
  return written(model_document(parsed, *placed, level), file);
}

}  // namespace psygen::editor
