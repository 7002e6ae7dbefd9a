#include "editor/document/parsed_world.hpp"

#include "engine/handmade/files.hpp"
#include "engine/world/files/world_file.hpp"

namespace psygen::editor {

core::Result<ParsedWorldPtr> parse_world_text(const std::string& text, const std::string& file_name,
                                              const RegisterModels& register_models,
                                              const world::ResourceLoader* files) {
  auto parsed = std::make_shared<ParsedWorld>();
  parsed->registry = models::make_standard_registry();
  if (register_models) {
    if (auto registered = register_models(parsed->registry); !registered)
      return tl::unexpected(std::move(registered.error()));
  }
  auto world = world::parse_world(text, file_name, parsed->registry,
                                  files != nullptr ? files : &handmade::files());
  if (!world) return tl::unexpected(std::move(world.error()));
  parsed->world = *std::move(world);
  return parsed;
}

}  // namespace psygen::editor
