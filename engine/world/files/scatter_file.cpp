#include "engine/world/files/scatter_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <iterator>

#include "engine/world/files/fields.hpp"
#include "engine/world/files/model_fields.hpp"
#include "engine/world/files/toml_values.hpp"
#include "engine/world/ground_blends.hpp"
#include "engine/world/placement.hpp"

namespace psygen::world {
namespace {

// log2 of the maximum number of triangles of all models of one block.
constexpr double kMaxLog2BlockCost = 26;
constexpr int kMaxSpacingSides = 4, kMaxWithinSpacing = 8192, kMaxFootCells = 64;
// Places that instances beside others try on a block, times the others within reach.
constexpr double kMaxBesideSteps = 4e6;
constexpr double kUsualBesideM = 5;         // beyond the distance that spacings need
constexpr Limits kMaskPlaces{-1e12, 1e12};  // metres
constexpr Limits kPlacePoints{-kFarthestShapeM, kFarthestShapeM};

// The index of the model type that the key "model" names, or −1 after a problem. The terrain is not
// allowed.
int read_model_name(TableReader& reader, const World& world, const models::Registry& registry) {
  std::string name;
  if (!reader.read("model", name, 64, Presence::kRequired)) return -1;
  const int index = registry.find(name);
  if (index >= 0 && index != world.terrain_model) return index;
  std::vector<std::string_view> known;
  for (models::ModelIndex i = 0; i < registry.size(); ++i) {
    if (i != world.terrain_model) known.push_back(registry[i].name());
  }
  reader.problem("model", fmt::format("there is no such model to scatter; allowed: {}",
                                      fmt::join(known, ", ")));
  return -1;
}

// The parameters of a model, which are ranges in a [[scatter]].
ModelFields read_model_fields(TableReader& reader, const models::ModelType& type, bool are_ranges) {
  ModelFields fields = fields_of(type, reader.line());
  const auto specs = type.parameters();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    if (specs[i].source == models::ParameterSource::kUser)
      read_parameter(reader, specs[i].name, i, are_ranges, fields);
  }
  return fields;
}

void read_grounds(TableReader& reader, ScatterMask& mask) {
  const Member* member = reader.find("on_ground");
  if (member == nullptr) return;
  const Node& node = member->value;
  std::uint32_t grounds = 0;
  bool sound = node.kind == Node::Kind::kArray && !node.items.empty();
  for (const Node& item : node.items) {
    const auto at = std::ranges::find(kGroundNames, item.text);
    sound = sound && item.kind == Node::Kind::kText && at != kGroundNames.end();
    if (sound) grounds |= 1U << (at - kGroundNames.begin());
  }
  if (sound)
    mask.ground = grounds;
  else
    reader.problem("on_ground",
                   fmt::format("it must be a list of kinds of ground, [\"grass\", …]; allowed: {}",
                               fmt::join(kGroundNames, ", ")));
}

// Without an area, the image covers the whole world.
void read_scatter_mask(TableReader& reader, const Beside& beside, const World& world,
                       ScatterMask& mask) {
  read_mask(reader, beside, mask);
  read_grounds(reader, mask);
  if (reader.find("mask_image") == nullptr || reader.find("mask_area_m") != nullptr) return;
  if (world.is_endless())
    return reader.problem("mask_image", "an endless world also needs mask_area_m");
  mask.area_m = {0, 0, static_cast<double>(world.blocks_x) * world.block_size_m(),
                 static_cast<double>(world.blocks_z) * world.block_size_m()};
}

// The number of models of a [[scatter]] per block, or 0 after a problem. Numbers that are too large
// are returned too, so the caller can reject them with their cost.
std::int64_t read_count(TableReader& reader) {
  const Member* member = reader.find("count");
  if (member != nullptr && member->value.kind == Node::Kind::kInteger &&
      member->value.integer > kMaxModelsPerBlock)
    return member->value.integer;
  std::int64_t count = 0;
  reader.read("count", count, {0, kMaxModelsPerBlock}, Presence::kRequired);
  return count;
}

// Reads the model that instances stand beside, and checks what the rules need.
void read_site(TableReader& reader, const World& world, const models::Registry& registry,
               Scatter& scatter) {
  SiteRules& site = scatter.site;
  if (std::isfinite(site.max_above_water_m) && !scatter.needs_water())
    reader.problem("max_above_water_m", "it needs near_water_m");
  if (site.min_slope_deg > scatter.max_slope_deg)
    reader.problem("min_slope_deg", "it must not be above max_slope_deg");
  if (site.near_road_m <= site.far_from_road_m)
    reader.problem("near_road_m", "it must be above far_from_road_m");
  if (site.edge_size < 1 && !(scatter.keeps_apart() && scatter.mask.thins()))
    reader.problem("edge_size", "it needs a mask and spacing_m");
  if (scatter.needs_water() && scatter.near_water_m <= site.far_from_water_m)
    reader.problem("near_water_m", "it must be above far_from_water_m");
  std::string name;
  const bool is_beside = reader.read("beside", name, 64);
  if (!is_beside && scatter.is_beside())
    return reader.problem("beside_m",
                          "it is the distance to the model of beside, which is missing");
  double widest_m = 0, narrowest_m = std::numeric_limits<double>::infinity();
  for (std::size_t s = 0; is_beside && s < world.scatter.size(); ++s) {
    const Scatter& other = world.scatter[s];
    if (registry[other.model].name() != name || !other.keeps_apart()) continue;
    site.beside |= std::uint64_t{1} << s;
    widest_m = std::max(widest_m, other.spacing_m);
    narrowest_m = std::min(narrowest_m, other.spacing_m);
  }
  if (is_beside && site.beside == 0)
    return reader.problem("beside", "no earlier [[scatter]] with a spacing_m has this model");
  if (narrowest_m < scatter.spacing_m)
    reader.problem("beside", fmt::format("spacing_m must be at most {:g} m, as in the earlier "
                                         "[[scatter]] of this model",
                                         narrowest_m));
  const double apart_m = scatter.keeps_apart() ? (widest_m + scatter.spacing_m) / 2 : 0;
  if (is_beside && reader.find("beside_m") == nullptr) site.beside_m = apart_m + kUsualBesideM;
  if (is_beside && site.beside_m <= apart_m)
    reader.problem(
        "beside_m",
        fmt::format("it must be above {:g} m, because spacings keep both apart", apart_m));
}

// Reports spacings and distances that reach too far, or over too many candidates to try.
void check_spacing(TableReader& root, int line, const World& world) {
  double candidates = 0, widest_m = 0;
  for (const Scatter& scatter : world.scatter) {
    if (!scatter.keeps_apart()) continue;
    candidates += scatter.count;
    widest_m = std::max(widest_m, scatter.spacing_m);
  }
  // One may stand beside another, which stands beside a third, and so on.
  for (const Scatter& scatter : world.scatter)
    widest_m += scatter.site.beside_m;
  const double sides = widest_m / world.block_size_m();
  if (sides > kMaxSpacingSides)
    return root.problem(
        line, "scatter",
        fmt::format("spacing_m and all beside_m reach {:g} m, too far: allowed are {} sides of a "
                    "block, {:g} m",
                    widest_m, kMaxSpacingSides, kMaxSpacingSides * world.block_size_m()));
  // The strips of blocks that a search walks through.
  const double within = 2 * sides * (2 * std::ceil(sides) + 1) * candidates;
  if (within > kMaxWithinSpacing)
    return root.problem(line, "scatter",
                        fmt::format("within the {:g} m of spacing_m and all beside_m, instances "
                                    "have {:.0f} others within reach, too many (allowed: {}); "
                                    "lower spacing_m, beside_m or count",
                                    widest_m, within, kMaxWithinSpacing),
                        core::ErrorCode::kOverBudget);
  double tries = 0;
  for (const Scatter& scatter : world.scatter)
    if (scatter.is_beside()) tries += scatter.count * (scatter.keeps_apart() ? 1 : kPlacementTries);
  if (tries * within > kMaxBesideSteps)
    root.problem(line, "scatter",
                 fmt::format("the tables with beside try {:.0f} places on a block, with {:.0f} "
                             "others within reach: too many (allowed: {:g} together); lower "
                             "count, or give them a spacing_m",
                             tries, within, kMaxBesideSteps),
                 core::ErrorCode::kOverBudget);
}

// Reads one [[scatter]]. Returns log2 of its largest number of triangles per block.
double read_scatter(TableReader& reader, const models::Registry& registry, const Beside& beside,
                    World& world) {
  const int model = read_model_name(reader, world, registry);
  if (model < 0) return 0;
  Scatter scatter;
  scatter.model = static_cast<models::ModelIndex>(model);
  const std::int64_t count = read_count(reader);
  const bool too_many = count > kMaxModelsPerBlock;
  scatter.count = too_many ? 0 : static_cast<std::uint32_t>(count);
  visit_place(scatter, FieldReader{reader});
  if (scatter.min_height_m > scatter.max_height_m)
    reader.problem(reader.line(), "min_height_m", "it must not be above max_height_m");
  if (const double max_m = std::min(kMaxFootCells * world.cell_m(), world.block_size_m() / 2);
      scatter.footprint_m > max_m)
    reader.problem("footprint_m",
                   fmt::format("it must be at most {:g} m: half a block's side and {} cells", max_m,
                               kMaxFootCells));
  read_scatter_mask(reader, beside, world, scatter.mask);
  read_site(reader, world, registry, scatter);
  ModelFields fields = read_model_fields(reader, registry[scatter.model], true);
  reader.finish();
  const bool allowed = check_model(fields, reader.problems()) && !too_many;
  const double cost =
      log2_cost(fields) + std::log2(std::max<double>(static_cast<double>(count), 1));
  if (too_many)
    reader.problem("count",
                   fmt::format("{} is not allowed: it must be an integer from 0 to {} ({} on each "
                               "block)",
                               count, kMaxModelsPerBlock, models::predicted_cost_text(cost)));
  scatter.ranges = std::move(fields.ranges);
  world.scatter.push_back(std::move(scatter));
  return allowed ? cost : 0;
}

// A seed that distinguishes equal models at different positions.
std::int64_t seed_at(const World& world, glm::dvec2 at_m) {
  const std::uint64_t x = std::bit_cast<std::uint64_t>(at_m.x + 0.0);
  const std::uint64_t z = std::bit_cast<std::uint64_t>(at_m.y + 0.0);
  return std::bit_cast<std::int64_t>(core::combine(core::combine(world.seed, x), z));
}

void read_place(TableReader& reader, const models::Registry& registry, const World& world,
                std::vector<Place>& places) {
  Place place;
  const int model = read_model_name(reader, world, registry);
  if (model < 0) return;
  place.model = static_cast<models::ModelIndex>(model);
  if (reader.read("at_m", place.at_m, kPlacePoints, Presence::kRequired)) {
    if (!world.contains(world.position(place.at_m).block))
      reader.problem("at_m",
                     fmt::format("{:g}, {:g} m is outside the world", place.at_m.x, place.at_m.y));
  }
  visit_placed(place, FieldReader{reader});
  const models::ModelType& type = registry[place.model];
  const ModelFields fields = read_model_fields(reader, type, false);
  reader.finish();
  if (!check_model(fields, reader.problems())) return;
  place.parameters = corner_of(fields, 0);
  if (const int seed = models::parameter_index(type, "seed");
      seed >= 0 &&
      type.parameters()[static_cast<std::size_t>(seed)].source == models::ParameterSource::kPlaced)
    place.parameters.set_integer(static_cast<std::size_t>(seed), seed_at(world, place.at_m));
  if (type.mesh_size(place.parameters, 0).layout != core::VertexLayout::kModel)
    return reader.problem("model", "this model type cannot be placed");
  places.push_back(place);
}

}  // namespace

void read_mask(TableReader& reader, const Beside& beside, ScatterMask& mask) {
  visit_mask(mask, FieldReader{reader});
  mask.picture = read_picture(reader, "mask_image", beside, mask.image);
  const bool given = reader.read("mask_area_m", mask.area_m, kMaskPlaces);
  if (reader.find("mask_image") == nullptr && reader.find("mask_area_m") != nullptr)
    reader.problem("mask_area_m", "it is the area of mask_image, which is missing");
  else if (given && !(mask.area_m[0] < mask.area_m[2] && mask.area_m[1] < mask.area_m[3]))
    reader.problem("mask_area_m", "it must be [x0, z0, x1, z1] with x0 below x1 and z0 below z1");
}

void write_mask(const ScatterMask& mask, std::string& text) {
  const auto out = std::back_inserter(text);
  if (!mask.image.empty()) fmt::format_to(out, "mask_image = {}\n", toml_string(mask.image));
  if (mask.area_m != std::array<double, 4>{})
    fmt::format_to(out, "mask_area_m = {}\n", toml_vector(mask.area_m));
  const ScatterMask usual;
  if (mask.noise_m != usual.noise_m || mask.share != usual.share || mask.patches != usual.patches)
    visit_mask(mask, FieldWriter{text});
  if (mask.ground != 0) fmt::format_to(out, "on_ground = {}\n", toml_grounds(mask.ground));
}

void read_scatters(TableReader& root, const models::Registry& registry, const Beside& beside,
                   World& world) {
  double triangles = 0;
  int line = root.line();
  for (TableReader& reader : root.tables("scatter", kMaxScatters)) {
    triangles += std::exp2(read_scatter(reader, registry, beside, world));
    line = reader.line();
  }
  if (models_per_block(world) > kMaxModelsPerBlock)
    root.problem(line, "scatter",
                 fmt::format("{} models on each block are too many (allowed: {})",
                             models_per_block(world), kMaxModelsPerBlock),
                 core::ErrorCode::kOverBudget);
  check_spacing(root, line, world);
  if (triangles > std::exp2(kMaxLog2BlockCost))
    root.problem(line, "scatter",
                 fmt::format("the models of one block together are too large (predicted: up to "
                             "{:.3g} million triangles; allowed: {:.0f} million)",
                             triangles / 1e6, std::exp2(kMaxLog2BlockCost) / 1e6),
                 core::ErrorCode::kOverBudget);
}

std::vector<Place> read_places(TableReader& root, const models::Registry& registry,
                               const World& world) {
  std::vector<Place> places;
  for (TableReader& reader : root.tables("place", kMaxPlaces))
    read_place(reader, registry, world, places);
  return places;
}

void write_scatters(const World& world, const models::Registry& registry, std::string& text) {
  const auto out = std::back_inserter(text);
  for (const Scatter& scatter : world.scatter) {
    const models::ModelType& type = registry[scatter.model];
    fmt::format_to(out, "\n[[scatter]]\nmodel = {}\ncount = {}\n", toml_string(type.name()),
                   scatter.count);
    write_changed(scatter, Scatter{}, visit_place, text);
    if (scatter.is_beside()) {
      const auto first = static_cast<std::size_t>(std::countr_zero(scatter.site.beside));
      fmt::format_to(out, "beside = {}\n",
                     toml_string(registry[world.scatter[first].model].name()));
    }
    write_mask(scatter.mask, text);
    for (std::size_t i = 0; i < scatter.ranges.size(); ++i) {
      const models::ParameterSpec& spec = type.parameters()[i];
      const auto [low, high] = scatter.ranges[i];
      if (spec.source != models::ParameterSource::kPlaced)
        fmt::format_to(out, "{} = {}\n", spec.name,
                       toml_range(low, high, spec.type == models::ParameterType::kInteger));
    }
  }
}

void write_places(const World& world, const models::Registry& registry, std::string& text) {
  const auto out = std::back_inserter(text);
  for (const Place& place : world.places.all) {
    const models::ModelType& type = registry[place.model];
    fmt::format_to(out, "\n[[place]]\nmodel = {}\nat_m = [{}, {}]\n", toml_string(type.name()),
                   place.at_m.x, place.at_m.y);
    visit_placed(place, FieldWriter{text});
    const auto specs = type.parameters();
    for (std::size_t i = 0; i < specs.size(); ++i) {
      if (specs[i].source != models::ParameterSource::kPlaced)
        fmt::format_to(out, "{} = {}\n", specs[i].name,
                       specs[i].type == models::ParameterType::kInteger
                           ? toml_number(place.parameters.integer(i))
                           : toml_number(place.parameters.real(i)));
    }
  }
}

std::shared_ptr<const GreyPicture> read_picture(TableReader& reader, std::string_view key,
                                                const Beside& beside, std::string& name,
                                                Presence presence) {
  if (!read_name_beside(reader, key, name, presence)) return nullptr;
  auto picture = beside.read_grey(name);
  if (picture) return std::move(*picture);
  reader.problem(key, picture.error().message, picture.error().code);
  return nullptr;
}

std::string toml_grounds(std::uint32_t grounds) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kGroundNames.size(); ++i)
    if ((grounds >> i & 1U) != 0) names.push_back(toml_string(kGroundNames[i]));
  return fmt::format("[{}]", fmt::join(names, ", "));
}

}  // namespace psygen::world
