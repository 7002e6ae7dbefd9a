// World → the text of a world file. Reading is in world_file.cpp.
#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <span>

#include "engine/core/hash.hpp"
#include "engine/world/files/fields.hpp"
#include "engine/world/files/handmade_file.hpp"
#include "engine/world/files/mask_file.hpp"
#include "engine/world/files/place_file.hpp"
#include "engine/world/files/shaped_file.hpp"
#include "engine/world/files/species_file.hpp"
#include "engine/world/files/toml_values.hpp"
#include "engine/world/files/world_file.hpp"
#include "engine/world/world.hpp"

namespace psygen::world {
namespace {

using Text = std::back_insert_iterator<std::string>;

std::string number(double value, models::ParameterType type) {
  return type == models::ParameterType::kInteger ? fmt::format("{}", std::llround(value))
                                                 : fmt::format("{}", value);
}

void write_terrain(Text out, const World& world, const models::ModelType& type) {
  const auto specs = type.parameters();
  for (const TerrainAlias& alias : kWorldKeys) {
    const auto i = static_cast<std::size_t>(models::parameter_index(type, alias.parameter));
    fmt::format_to(out, "{} = {}\n", alias.key,
                   number(models::parameter_number(type, world.terrain, i), specs[i].type));
  }
  fmt::format_to(out, "\n[terrain]\n");
  for (std::size_t i = 0; i < specs.size(); ++i) {
    bool elsewhere = specs[i].source == models::ParameterSource::kPlaced;
    for (const TerrainAlias& alias : kWorldKeys)
      elsewhere = elsewhere || alias.parameter == specs[i].name;
    if (!elsewhere)
      fmt::format_to(out, "{} = {}\n", specs[i].name,
                     number(models::parameter_number(type, world.terrain, i), specs[i].type));
  }
}

void write_scatter(std::string& text, const Scatter& scatter, const models::ModelType& type) {
  const Text out(text);
  fmt::format_to(out, "\n[[scatter]]\nmodel = {}\ncount = {}\n", toml_string(type.name()),
                 scatter.count);
  if (std::isfinite(scatter.min_height_m))
    fmt::format_to(out, "min_height_m = {}\n", scatter.min_height_m);
  if (std::isfinite(scatter.max_height_m))
    fmt::format_to(out, "max_height_m = {}\n", scatter.max_height_m);
  if (scatter.max_slope_deg < 90)
    fmt::format_to(out, "max_slope_deg = {}\n", scatter.max_slope_deg);
  write_mask(scatter.mask, text);
  for (std::size_t i = 0; i < scatter.ranges.size(); ++i) {
    const models::ParameterSpec& spec = type.parameters()[i];
    const ParameterRange& range = scatter.ranges[i];
    if (spec.source == models::ParameterSource::kPlaced) continue;
    if (range.low == range.high) {
      fmt::format_to(out, "{} = {}\n", spec.name, number(range.low, spec.type));
    } else {
      fmt::format_to(out, "{} = [{}, {}]\n", spec.name, number(range.low, spec.type),
                     number(range.high, spec.type));
    }
  }
}

}  // namespace

std::string write_world(const World& world, const models::Registry& registry) {
  std::string text;
  const Text out(text);
  fmt::format_to(out, "format = {}\n\n[world]\nname = {}\nseed = {}\nblocks = [{}, {}]\n",
                 world.format, toml_string(world.name), toml_seed(world.seed), world.blocks_x,
                 world.blocks_z);
  write_terrain(out, world, registry[world.terrain_model]);
  write_species(world.species, text);
  write_handmade(world.models, text);
  for (const Scatter& scatter : world.scatter)
    write_scatter(text, scatter, registry[scatter.model]);
  write_places(world, registry, text);
  write_shaped(world.shaped, text);
  fmt::format_to(out, "\n[sky]\n");
  visit_sky(world.sky, FieldWriter{text});
  fmt::format_to(out, "\n[water]\n");
  visit_water(world.water, FieldWriter{text});
  fmt::format_to(out, "\n[palette]\n");
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
