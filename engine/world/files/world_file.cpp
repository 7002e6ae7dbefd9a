// World files. The [[scatter]] and [[place]] tables are in scatter_file.cpp, the species in
// species_file.cpp, the handmade models in handmade_file.cpp, stamps and roads in shaped_file.cpp.
// docs/world-files.md describes the format.
#include "engine/world/files/world_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>
#include <span>

#include "engine/core/hash.hpp"
#include "engine/core/log.hpp"
#include "engine/core/rounding.hpp"
#include "engine/core/utf8.hpp"
#include "engine/world/files/document.hpp"
#include "engine/world/files/fields.hpp"
#include "engine/world/files/model_fields.hpp"
#include "engine/world/files/scatter_file.hpp"
#include "engine/world/files/shaped_file.hpp"
#include "engine/world/files/species_file.hpp"
#include "engine/world/files/table_reader.hpp"
#include "engine/world/files/text_file.hpp"
#include "engine/world/files/toml_values.hpp"
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
      "seed",
      fmt::format("{} is not allowed: it must be an integer from 0 to {}, or a string of digits up "
                  "to \"{}\"",
                  node.kind == Node::Kind::kText
                      ? fmt::format("\"{}\"", core::shown(node.text, kMaxShownBytes))
                      : value_text(node),
                  INT64_MAX, UINT64_MAX));
}

void read_world_table(TableReader& root, World& world, ModelFields& terrain) {
  std::optional<TableReader> reader = root.table("world", Presence::kRequired);
  if (!reader) return;
  reader->read("name", world.name, kMaxNameBytes, Presence::kRequired);
  read_seed(*reader, world.seed);
  std::int64_t blocks[2] = {0, 0};
  if (reader->read_pair("blocks", blocks, {kBlocks.hard.min, kBlocks.hard.max},
                        Presence::kRequired)) {
    world.blocks_x = blocks[0];
    world.blocks_z = blocks[1];
  }
  for (const TerrainAlias& alias : kWorldKeys) {
    const int i = models::parameter_index(*terrain.type, alias.parameter);
    read_parameter(*reader, alias.key, static_cast<std::size_t>(i), false, terrain);
  }
  reader->finish();
}

void read_terrain_table(TableReader& root, ModelFields& terrain) {
  std::optional<TableReader> reader = root.table("terrain");
  if (!reader) return;
  const auto specs = terrain.type->parameters();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    if (is_terrain_key(specs[i])) read_parameter(*reader, specs[i].name, i, false, terrain);
  }
  reader->finish();
}

// Reads the fields of a table. `visit_fields` calls its argument for every field (fields.hpp).
void read_fields(TableReader& root, std::string_view name, auto& values, const auto& visit_fields) {
  std::optional<TableReader> reader = root.table(name);
  if (!reader) return;
  visit_fields(values, FieldReader{*reader});
  reader->finish();
}

// The palette with the names of its images.
void read_palette(TableReader& root, Palette& palette) {
  read_fields(root, "palette", palette, [](Palette& fields, const FieldReader& visit) {
    visit_palette(fields, visit);
    for (std::size_t i = 0; i < kPaletteImages.size(); ++i)
      read_name_beside(visit.reader, kPaletteImages[i], fields.images[i]);
  });
}

// The default sky: its colours are computed for the sun's elevation in the file. Wrong values are
// reported later, when the table is read.
Sky usual_sky(const Node& root) {
  const Sky usual;
  SunPlace sun{usual.sun_azimuth_deg, usual.sun_elevation_deg};
  Problems deferred_problems("");
  if (auto reader = TableReader(root, "", 1, deferred_problems).table("sky"))
    reader->read("sun_elevation_deg", sun.elevation_deg, {-90, 90});
  return with_sun(usual, sun);
}

// Adds the species of a world to the registry `grown`; null: the registry cannot grow.
void register_species(TableReader& root, const World& world, const models::Registry& registry,
                      models::Registry* grown) {
  std::vector<TableReader> readers = root.tables("species", kMaxSpecies);
  for (std::size_t i = 0; i < world.species.size(); ++i) {
    auto type = models::make_species_type(world.species[i]);
    const auto refused = type ? register_type(std::move(*type), registry, grown)
                              : std::optional(type.error().message);
    if (refused) return readers[i].problem(readers[i].line(), "name", *refused);
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
  read_world_table(root, world, terrain);
  read_terrain_table(root, terrain);
  check_model(terrain, problems);
  world.terrain = corner_of(terrain, 0);
  Problems of_types(file_name);
  TableReader types(*document, "", 1, of_types);
  world.species = read_species(types);
  if (!of_types.any()) register_species(types, world, registry, grown);
  world.models = read_handmade(types, {{file_name, beside}, registry, grown});
  if (of_types.any()) return tl::unexpected(problems.any() ? problems.first() : of_types.first());
  for (const char* key : {"species", "model"})
    (void)root.find(key);  // finish() must know them
  PictureSum pictures;
  const Beside files{file_name, beside, &pictures};
  read_scatters(root, registry, files, world);
  world.sky = usual_sky(*document);
  read_fields(root, "sky", world.sky, visit_sky);
  read_fields(root, "water", world.water, visit_water);
  read_palette(root, world.palette);
  world.places.all = read_places(root, registry, world);
  world.shaped = read_shaped(root, files);
  root.finish();
  if (problems.any()) return tl::unexpected(problems.first());
  world.terrain = terrain_parameters(world, {0, 0});
  shape_world(root, world);
  if (problems.any()) return tl::unexpected(problems.first());
  sort_places(world, registry);
  return world;
}

void write_terrain(std::string& text, const World& world, const models::ModelType& type) {
  const auto out = std::back_inserter(text);
  const auto specs = type.parameters();
  const auto write = [&](std::string_view key, std::size_t i) {
    const double value = models::parameter_number(type, world.terrain, i);
    fmt::format_to(out, "{} = {}\n", key,
                   toml_range(value, value, specs[i].type == models::ParameterType::kInteger));
  };
  for (const TerrainAlias& alias : kWorldKeys)
    write(alias.key, static_cast<std::size_t>(models::parameter_index(type, alias.parameter)));
  text += "\n[terrain]\n";
  for (std::size_t i = 0; i < specs.size(); ++i)
    if (is_terrain_key(specs[i])) write(specs[i].name, i);
}

}  // namespace

core::Result<World> parse_world(std::string_view text, std::string_view file_name,
                                models::Registry& registry, const ResourceLoader* beside) {
  const core::RoundToNearest rounding;
  const std::size_t before = registry.size();
  auto world = read_world(text, file_name, registry, &registry, beside);
  if (!world) registry.shrink(before);
  return world;
}

core::Result<World> parse_world(std::string_view text, std::string_view file_name,
                                const models::Registry& registry, const ResourceLoader* beside) {
  const core::RoundToNearest rounding;
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

void log_warnings(const World& world, std::string_view file_name) {
  for (const std::string& warning : world.shaped.warnings)
    core::log_warning(fmt::format("{}: {}", file_name, warning));
}

std::string write_world(const World& world, const models::Registry& registry) {
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "format = {}\n\n[world]\nname = {}\nseed = {}\nblocks = [{}, {}]\n",
                 world.format, toml_string(world.name), toml_seed(world.seed), world.blocks_x,
                 world.blocks_z);
  write_terrain(text, world, registry[world.terrain_model]);
  write_species(world.species, text);
  write_handmade(world.models, text);
  write_scatters(world, registry, text);
  write_places(world, registry, text);
  write_shaped(world.shaped, text);
  if (world.shaped.erosion != models::Erosion()) {
    text += "\n[erosion]\n";
    models::visit_erosion(world.shaped.erosion, FieldWriter{text});
  }
  if (world.shaped.network) {
    text += "\n[rivers]\n";
    visit_rivers(*world.shaped.network, FieldWriter{text});
  }
  text += "\n[sky]\n";
  visit_sky(world.sky, FieldWriter{text});
  text += "\n[water]\n";
  visit_water(world.water, FieldWriter{text});
  text += "\n[palette]\n";
  visit_palette(world.palette, FieldWriter{text});
  for (std::size_t i = 0; i < kPaletteImages.size(); ++i) {
    const std::string& name = world.palette.images[i];
    if (!name.empty()) fmt::format_to(out, "{} = {}\n", kPaletteImages[i], toml_string(name));
  }
  return text;
}

std::uint64_t world_hash(const World& world, const models::Registry& registry) {
  const std::string text = write_world(world, registry);
  return core::hash_bytes(std::as_bytes(std::span(text)), world.files_hash);
}

}  // namespace psygen::world
