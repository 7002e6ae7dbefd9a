// World files: text → World. The [[scatter]] tables are read in scatter_file.cpp, the species in
// species_file.cpp, the handmade models in handmade_file.cpp, stamps and roads in shaped_file.cpp,
// models placed by hand in place_file.cpp. Writing is in write_world.cpp. docs/world-files.md
// describes the format.
#include "engine/world/files/world_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "engine/core/utf8.hpp"
#include "engine/world/files/document.hpp"
#include "engine/world/files/fields.hpp"
#include "engine/world/files/handmade_file.hpp"
#include "engine/world/files/model_fields.hpp"
#include "engine/world/files/place_file.hpp"
#include "engine/world/files/scatter_file.hpp"
#include "engine/world/files/shaped_file.hpp"
#include "engine/world/files/species_file.hpp"
#include "engine/world/files/table_reader.hpp"
#include "engine/world/files/text_file.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {
namespace {

constexpr std::size_t kMaxNameBytes = 128;

// Seeds have 64 bits. TOML integers are below 2^63, so larger seeds are strings of digits.
void read_seed(TableReader& reader, std::uint64_t& seed) {
  const Member* member = reader.find("seed", Presence::kRequired);
  if (member == nullptr) return;
  const Node& node = member->value;
  const std::string digits =
      node.kind == Node::Kind::kInteger ? fmt::format("{}", node.integer) : node.text;
  const char* const end = digits.data() + digits.size();
  std::uint64_t value = 0;
  const auto parsed = std::from_chars(digits.data(), end, value);
  if (parsed.ec == std::errc() && parsed.ptr == end) {
    seed = value;
    return;
  }
  constexpr std::size_t kMaxShownBytes = 40;
  reader.problem(
      node.line, "seed",
      fmt::format("{} is not allowed: it must be an integer from 0 to {}, or a string of digits up "
                  "to \"{}\"",
                  node.kind == Node::Kind::kText
                      ? fmt::format("\"{}\"", core::shown(node.text, kMaxShownBytes))
                      : value_text(node),
                  INT64_MAX, UINT64_MAX));
}

void read_world_table(TableReader& root, World& world, ModelFields& terrain, Problems& problems) {
  const Member* member = root.table("world", Presence::kRequired);
  if (member == nullptr) return;
  TableReader reader(member->value, "world", member->line, problems);
  reader.read("name", world.name, kMaxNameBytes, Presence::kRequired);
  read_seed(reader, world.seed);
  std::int64_t blocks[2] = {0, 0};
  if (reader.read_pair("blocks", blocks, {kBlocks.low, kBlocks.high}, Presence::kRequired)) {
    world.blocks_x = blocks[0];
    world.blocks_z = blocks[1];
  }
  for (const TerrainAlias& alias : kWorldKeys) {
    const int i = models::parameter_index(*terrain.type, alias.parameter);
    read_parameter(reader, alias.key, static_cast<std::size_t>(i), false, terrain);
  }
  reader.finish();
}

bool is_world_key(std::string_view parameter) {
  for (const TerrainAlias& alias : kWorldKeys) {
    if (alias.parameter == parameter) return true;
  }
  return false;
}

void read_terrain_table(TableReader& root, ModelFields& terrain, Problems& problems) {
  const Member* member = root.table("terrain");
  if (member == nullptr) return;
  TableReader reader(member->value, "terrain", member->line, problems);
  const auto specs = terrain.type->parameters();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    if (specs[i].source == models::ParameterSource::kUser && !is_world_key(specs[i].name))
      read_parameter(reader, specs[i].name, i, false, terrain);
  }
  reader.finish();
}

// Reads the fields of a table. `visit_fields` calls its argument for every field (fields.hpp).
template <class VisitFields>
void read_fields(TableReader& root, std::string_view name, Problems& problems,
                 const VisitFields& visit_fields) {
  const Member* member = root.table(name);
  if (member == nullptr) return;
  TableReader reader(member->value, std::string(name), member->line, problems);
  visit_fields([&reader](std::string_view key, auto& field, const FieldSpec& spec) {
    reader.read(key, field, Limits{spec.low, spec.high});
  });
  reader.finish();
}

// The palette with the names of its images, which must not lead out of the world's folder.
void read_palette(TableReader& root, Palette& palette, Problems& problems) {
  constexpr std::size_t kLongestName = 200;  // bytes
  const Member* member = root.table("palette");
  if (member == nullptr) return;
  TableReader reader(member->value, "palette", member->line, problems);
  visit_palette(palette, [&reader](std::string_view key, auto& field, const FieldSpec& spec) {
    reader.read(key, field, Limits{spec.low, spec.high});
  });
  for (std::size_t i = 0; i < kPaletteImages.size(); ++i) {
    const std::string_view key = kPaletteImages[i];
    if (reader.read(key, palette.images[i], kLongestName))
      check_name_beside(reader, key, palette.images[i]);
  }
  reader.finish();
}

// The default sky: its colours are computed for the sun's elevation in the file. Wrong values are
// reported later, when the table is read.
Sky usual_sky(TableReader& root) {
  const Sky usual;
  const Member* member = root.table("sky");
  if (member == nullptr) return usual;
  SunPlace sun{usual.sun_azimuth_deg, usual.sun_elevation_deg};
  Problems deferred_problems("");
  TableReader reader(member->value, "sky", member->line, deferred_problems);
  reader.read("sun_elevation_deg", sun.elevation_deg, {-90, 90});
  return with_sun(usual, sun);
}

// Adds the species of a world to the registry `grown`; null: the registry cannot grow.
void register_species(TableReader& root, const World& world, const models::Registry& registry,
                      models::Registry* grown, Problems& problems) {
  const std::vector<const Node*> nodes = root.tables("species", kMaxSpecies);
  for (std::size_t i = 0; i < world.species.size(); ++i) {
    const models::Species& species = world.species[i];
    const auto refuse = [&](std::string_view sentence) {
      problems.add(nodes[i]->line, fmt::format("species[{}].name", i), sentence);
    };
    auto type = models::make_species_type(species);
    if (!type) return refuse(type.error().message);
    const int known = registry.find(species.name);
    if (known >= 0) {
      const models::ModelType& there = registry[static_cast<models::ModelIndex>(known)];
      if (there.identity() != (*type)->identity())
        return refuse(fmt::format("another model is named {}", species.name));
    } else if (grown == nullptr) {
      return refuse("this registry does not accept new species");
    } else if (auto added = grown->add(std::move(*type)); !added) {
      return refuse(added.error().message);
    }
  }
}

core::Result<World> read_world(std::string_view text, std::string_view file_name,
                               const models::Registry& registry, models::Registry* grown,
                               const ResourceLoader* beside) {
  const int terrain_model = registry.find("terrain");
  if (terrain_model < 0)
    return core::fail(core::ErrorCode::kInvalidArgument, "there is no model type named terrain");
  const core::Result<Node> document = parse_document(text, file_name);
  if (!document) return tl::unexpected(document.error());

  Problems problems(file_name);
  TableReader root(*document, "", 1, problems);
  World world;
  world.terrain_model = static_cast<models::ModelIndex>(terrain_model);
  ModelFields terrain = fields_of(registry[world.terrain_model], 1);
  read_format(root, kWorldFormat);
  // For another version, errors about other fields would be misleading.
  if (problems.any()) return tl::unexpected(problems.first());
  read_world_table(root, world, terrain, problems);
  read_terrain_table(root, terrain, problems);
  check_model(terrain, problems);
  world.terrain = corner_of(terrain, 0);
  Problems of_types(file_name);
  world.species = read_species(root, of_types);
  if (!of_types.any()) register_species(root, world, registry, grown, of_types);
  world.models = read_handmade(root, {{file_name, beside}, registry, grown}, of_types);
  if (of_types.any()) return tl::unexpected(problems.any() ? problems.first() : of_types.first());
  read_scatters(root, registry, {file_name, beside}, world, problems);
  world.sky = usual_sky(root);
  read_fields(root, "sky", problems, [&](const auto& visit) { visit_sky(world.sky, visit); });
  read_fields(root, "water", problems, [&](const auto& visit) { visit_water(world.water, visit); });
  read_palette(root, world.palette, problems);
  world.places.all = read_places(root, registry, world, problems);
  world.shaped = read_shaped(root, {file_name, beside}, problems);
  root.finish();
  if (problems.any()) return tl::unexpected(problems.first());
  world.terrain = terrain_parameters(world, {0, 0});
  shape_world(root, world, problems);
  if (problems.any()) return tl::unexpected(problems.first());
  sort_places(world, registry);
  return world;
}

}  // namespace

core::Result<World> parse_world(std::string_view text, std::string_view file_name,
                                models::Registry& registry, const ResourceLoader* beside) {
  const std::size_t before = registry.size();
  auto world = read_world(text, file_name, registry, &registry, beside);
  if (!world) registry.shrink(before);
  return world;
}

core::Result<World> parse_world(std::string_view text, std::string_view file_name,
                                const models::Registry& registry, const ResourceLoader* beside) {
  return read_world(text, file_name, registry, nullptr, beside);
}

core::Result<World> load_world(const std::filesystem::path& file, models::Registry& registry,
                               const ResourceLoader* beside) {
  const core::Result<std::string> text = read_text_file(file);
  if (!text) return tl::unexpected(text.error());
  return parse_world(*text, file.string(), registry, beside);
}

core::Result<World> load_world(const std::filesystem::path& file, const models::Registry& registry,
                               const ResourceLoader* beside) {
  const core::Result<std::string> text = read_text_file(file);
  if (!text) return tl::unexpected(text.error());
  return parse_world(*text, file.string(), registry, beside);
}

}  // namespace psygen::world
