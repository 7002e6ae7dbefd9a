// World files: text → World. Writing is in write_world.cpp, the format in docs/world-files.md.
#include <fmt/format.h>

#include <cmath>

#include "engine/world/document.hpp"
#include "engine/world/fields.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/species_file.hpp"
#include "engine/world/table_reader.hpp"
#include "engine/world/text_file.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {
namespace {

constexpr std::size_t kMaxScatters = 64;
constexpr std::size_t kMaxNameBytes = 128;
constexpr double kMaxSeed = 0x1.0p63;
constexpr double kMaxBlocks = 0x1.0p31;
// Of the triangles that the models of one block can have at most, as log2.
constexpr double kMaxLog2BlockCost = 26;

// The ranges of one model as the file gives them, with the lines for messages.
struct ModelFields {
  const models::ModelType* type = nullptr;
  std::vector<ParameterRange> ranges;
  std::vector<int> lines;
  std::vector<std::string> names;  // as the file calls them
};

ModelFields fields_of(const models::ModelType& type, int line) {
  ModelFields fields{&type, {}, {}, {}};
  for (const models::ParameterSpec& spec : type.parameters()) {
    fields.ranges.push_back({spec.default_value, spec.default_value});
    fields.lines.push_back(line);
    fields.names.emplace_back(spec.name);
  }
  return fields;
}

void read_parameter(TableReader& reader, std::string_view key, std::size_t i, bool is_range,
                    ModelFields& fields) {
  fields.names[i] = reader.field(key);
  const std::optional<NumberRange> range = reader.read_range(key);
  if (!range) return;
  fields.lines[i] = range->line;
  const bool integer = fields.type->parameters()[i].type == models::ParameterType::kInteger;
  if (integer && !range->integers) {
    reader.problem(range->line, key, "it must be an integer, or [lowest, highest] of integers");
  } else if (!is_range && range->low != range->high) {
    reader.problem(range->line, key, "it must be one number, the same for the whole world");
  } else {
    fields.ranges[i] = {range->low, range->high};
  }
}

models::Parameters corner_of(const ModelFields& fields, std::uint32_t corner) {
  models::Parameters p = models::default_parameters(*fields.type);
  std::uint32_t bit = 0;
  for (std::size_t i = 0; i < fields.ranges.size(); ++i) {
    const ParameterRange& range = fields.ranges[i];
    if (fields.type->parameters()[i].source == models::ParameterSource::kPlaced) continue;
    const bool high = range.low != range.high && (corner >> bit++ & 1U) != 0;
    set_parameter(*fields.type, p, i, high ? range.high : range.low);
  }
  return p;
}

// The parameter that lies outside its hard range, or the one of the last line for costs that only
// all of them together exceed.
std::size_t culprit_of(const ModelFields& fields, const models::Parameters& p) {
  const auto specs = fields.type->parameters();
  std::size_t last = 0;
  for (std::size_t i = 0; i < specs.size(); ++i) {
    const double value = specs[i].type == models::ParameterType::kInteger
                             ? static_cast<double>(p.integer(i))
                             : p.real(i);
    if (!(value >= specs[i].hard_min && value <= specs[i].hard_max)) return i;
    if (fields.lines[i] > fields.lines[last]) last = i;
  }
  return last;
}

// Asks the model about every corner of its ranges. Returns the largest cost as log2 of triangles.
double check_model(const ModelFields& fields, Problems& problems) {
  std::uint32_t ranged = 0;
  for (const ParameterRange& range : fields.ranges)
    ranged += range.low != range.high ? 1 : 0;
  double cost = 0;
  for (std::uint32_t corner = 0; corner < (1U << ranged); ++corner) {
    const models::Parameters p = corner_of(fields, corner);
    if (const auto valid = models::validate(*fields.type, p); !valid) {
      const std::size_t i = culprit_of(fields, p);
      problems.add(fields.lines[i], fields.names[i], valid.error().message, valid.error().code);
      return 0;
    }
    cost = std::max(cost, fields.type->log2_cost(p));
  }
  return cost;
}

void read_world_table(TableReader& root, World& world, ModelFields& terrain, Problems& problems) {
  const Member* member = root.table("world", Presence::kRequired);
  if (member == nullptr) return;
  TableReader reader(member->value, "world", member->line, problems);
  reader.read("name", world.name, kMaxNameBytes, Presence::kRequired);
  std::int64_t seed = 0;
  if (reader.read("seed", seed, {0, kMaxSeed}, Presence::kRequired))
    world.seed = static_cast<std::uint64_t>(seed);
  std::int64_t blocks[2] = {0, 0};
  if (reader.read_pair("blocks", blocks, {0, kMaxBlocks}, Presence::kRequired)) {
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

// The index of the named model, or −1 after a problem.
int read_model_name(TableReader& reader, const World& world, const models::Registry& registry) {
  std::string name;
  if (!reader.read("model", name, 64, Presence::kRequired)) return -1;
  const int index = registry.find(name);
  if (index >= 0 && index != world.terrain_model) return index;
  std::vector<std::string> known;
  for (models::ModelIndex i = 0; i < registry.size(); ++i) {
    if (i != world.terrain_model) known.emplace_back(registry[i].name());
  }
  reader.problem(
      reader.find("model")->line, "model",
      fmt::format("there is no such model to scatter; allowed: {}", fmt::join(known, ", ")));
  return -1;
}

// Reads one [[scatter]]; returns log2 of the triangles that it can have in one block.
double read_scatter(const Node& node, std::size_t number, const models::Registry& registry,
                    World& world, Problems& problems) {
  TableReader reader(node, fmt::format("scatter[{}]", number), node.line, problems);
  const int model = read_model_name(reader, world, registry);
  if (model < 0) return 0;
  Scatter scatter;
  scatter.model = static_cast<models::ModelIndex>(model);
  std::int64_t count = 0;
  reader.read("count", count, {0, kMaxModelsPerBlock}, Presence::kRequired);
  scatter.count = static_cast<std::uint32_t>(count);
  reader.read("min_height_m", scatter.min_height_m, kPlaceHeights);
  reader.read("max_height_m", scatter.max_height_m, kPlaceHeights);
  reader.read("max_slope_deg", scatter.max_slope_deg, kSlopes);
  if (scatter.min_height_m > scatter.max_height_m)
    reader.problem(node.line, "min_height_m", "it must not be above max_height_m");

  ModelFields fields = fields_of(registry[scatter.model], node.line);
  const auto specs = fields.type->parameters();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    if (specs[i].source == models::ParameterSource::kUser)
      read_parameter(reader, specs[i].name, i, true, fields);
  }
  reader.finish();
  const double cost = check_model(fields, problems);
  scatter.ranges = std::move(fields.ranges);
  world.scatter.push_back(std::move(scatter));
  return cost + std::log2(std::max<double>(static_cast<double>(count), 1));
}

void read_scatters(TableReader& root, const models::Registry& registry, World& world,
                   Problems& problems) {
  double triangles = 0;
  std::size_t number = 0;
  int line = root.line();
  for (const Node* node : root.tables("scatter", kMaxScatters)) {
    triangles += std::exp2(read_scatter(*node, number++, registry, world, problems));
    line = node->line;
  }
  if (models_per_block(world) > kMaxModelsPerBlock)
    problems.add(line, "scatter",
                 fmt::format("{} models on each block are too many (allowed: {})",
                             models_per_block(world), kMaxModelsPerBlock),
                 core::ErrorCode::kOverBudget);
  if (triangles > std::exp2(kMaxLog2BlockCost))
    problems.add(line, "scatter",
                 fmt::format("the models of one block together are too large (predicted cost: up "
                             "to {:.3g} triangles; allowed: 2^{:g})",
                             triangles, kMaxLog2BlockCost),
                 core::ErrorCode::kOverBudget);
}

// `visit_fields` hands every field of the table to the function that it is given (fields.hpp).
template <class VisitFields>
void read_fields(TableReader& root, std::string_view name, Problems& problems,
                 const VisitFields& visit_fields) {
  const Member* member = root.table(name);
  if (member == nullptr) return;
  TableReader reader(member->value, std::string(name), member->line, problems);
  visit_fields([&reader](std::string_view key, auto& field, Limits limits) {
    reader.read(key, field, limits);
  });
  reader.finish();
}

}  // namespace

namespace {

// The sky of a file that gives no colours: what the sun makes of the air at the file's elevation.
// Wrong values are told when the table is read.
Sky usual_sky(TableReader& root) {
  const Sky usual;
  const Member* member = root.table("sky");
  if (member == nullptr) return usual;
  SunPlace sun{usual.sun_azimuth_deg, usual.sun_elevation_deg};
  Problems told_later("");
  TableReader reader(member->value, "sky", member->line, told_later);
  reader.read("sun_elevation_deg", sun.elevation_deg, {-90, 90});
  return with_sun(usual, sun);
}

// Makes the species of a world models of the registry; `grown` is null where it cannot grow.
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
        return refuse(fmt::format("there is another model called {}", species.name));
    } else if (grown == nullptr) {
      return refuse("species cannot be added here");
    } else if (auto added = grown->add(std::move(*type)); !added) {
      return refuse(added.error().message);
    }
  }
}

core::Result<World> read_world(std::string_view text, std::string_view file_name,
                               const models::Registry& registry, models::Registry* grown) {
  const int terrain_model = registry.find("terrain");
  if (terrain_model < 0)
    return core::fail(core::ErrorCode::kInvalidArgument, "no model type is called terrain");
  const core::Result<Node> document = parse_document(text, file_name);
  if (!document) return tl::unexpected(document.error());

  Problems problems(file_name);
  TableReader root(*document, "", 1, problems);
  World world;
  world.terrain_model = static_cast<models::ModelIndex>(terrain_model);
  ModelFields terrain = fields_of(registry[world.terrain_model], 1);
  read_format(root, kWorldFormat);
  // Another version may break any other rule of this one.
  if (problems.any()) return tl::unexpected(problems.first());
  read_world_table(root, world, terrain, problems);
  read_terrain_table(root, terrain, problems);
  check_model(terrain, problems);
  world.terrain = corner_of(terrain, 0);
  Problems of_species(file_name);
  world.species = read_species(root, of_species);
  if (!of_species.any()) register_species(root, world, registry, grown, of_species);
  if (of_species.any())
    return tl::unexpected(problems.any() ? problems.first() : of_species.first());
  read_scatters(root, registry, world, problems);
  world.sky = usual_sky(root);
  read_fields(root, "sky", problems, [&](const auto& visit) { visit_sky(world.sky, visit); });
  read_fields(root, "water", problems, [&](const auto& visit) { visit_water(world.water, visit); });
  read_fields(root, "palette", problems,
              [&](const auto& visit) { visit_palette(world.palette, visit); });
  root.finish();
  if (problems.any()) return tl::unexpected(problems.first());
  world.terrain = terrain_parameters(world, {0, 0});
  return world;
}

}  // namespace

core::Result<World> parse_world(std::string_view text, std::string_view file_name,
                                models::Registry& registry) {
  const std::size_t before = registry.size();
  auto world = read_world(text, file_name, registry, &registry);
  if (!world) registry.shrink(before);
  return world;
}

core::Result<World> parse_world(std::string_view text, std::string_view file_name,
                                const models::Registry& registry) {
  return read_world(text, file_name, registry, nullptr);
}

core::Result<World> load_world(const std::filesystem::path& file, models::Registry& registry) {
  const core::Result<std::string> text = read_text_file(file);
  if (!text) return tl::unexpected(text.error());
  return parse_world(*text, file.string(), registry);
}

core::Result<World> load_world(const std::filesystem::path& file,
                               const models::Registry& registry) {
  const core::Result<std::string> text = read_text_file(file);
  if (!text) return tl::unexpected(text.error());
  return parse_world(*text, file.string(), registry);
}

}  // namespace psygen::world
