#include "editor/document/parsed_world.hpp"

#include <algorithm>

#include "engine/handmade/files.hpp"
#include "engine/world/files/world_file.hpp"

namespace psygen::editor {
namespace {

bool same_tables(const ParsedWorld& a, const ParsedWorld& b) {
  const auto same_species = [](const models::Species& x, const models::Species& y) {
    return x.name == y.name && x.kinds.size() == y.kinds.size() && x.rules.size() == y.rules.size();
  };
  const auto same_scatter = [&](const world::Scatter& x, const world::Scatter& y) {
    return a.registry[x.model].name() == b.registry[y.model].name();
  };
  return std::ranges::equal(a.world.species, b.world.species, same_species) &&
         std::ranges::equal(a.world.models, b.world.models, {}, &world::HandmadeModel::name,
                            &world::HandmadeModel::name) &&
         std::ranges::equal(a.world.scatter, b.world.scatter, same_scatter);
}

}  // namespace

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

Changes changes_between(const ParsedWorld& before, const ParsedWorld& after) {
  const world::World &a = before.world, &b = after.world;
  Changes changes;
  const auto note = [&changes](bool same, Change change) { changes.setFlag(change, !same); };
  note(a.name == b.name && a.seed == b.seed && a.blocks_x == b.blocks_x && a.blocks_z == b.blocks_z,
       Change::kWorld);
  note(a.terrain == b.terrain, Change::kTerrain);
  note(a.sky == b.sky, Change::kSky);
  note(a.water == b.water, Change::kWater);
  note(a.palette == b.palette, Change::kPalette);
  note(a.species == b.species, Change::kSpecies);
  note(a.scatter == b.scatter && a.models == b.models, Change::kScatter);
  note(same_tables(before, after), Change::kTables);
  return changes;
}

}  // namespace psygen::editor
