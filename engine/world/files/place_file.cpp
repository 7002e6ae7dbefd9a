#include "engine/world/files/place_file.hpp"

#include <fmt/format.h>

#include <bit>
#include <iterator>

#include "engine/world/files/fields.hpp"
#include "engine/world/files/model_fields.hpp"
#include "engine/world/files/scatter_file.hpp"
#include "engine/world/files/toml_values.hpp"

namespace psygen::world {
namespace {

constexpr Limits kPlacePoints{-kFarthestShapeM, kFarthestShapeM};

// A seed that distinguishes equal models at different positions.
std::int64_t seed_at(const World& world, glm::dvec2 at_m) {
  const std::uint64_t x = std::bit_cast<std::uint64_t>(at_m.x + 0.0);
  const std::uint64_t z = std::bit_cast<std::uint64_t>(at_m.y + 0.0);
  return std::bit_cast<std::int64_t>(core::combine(core::combine(world.seed, x), z));
}

void read_place(const Node& node, std::size_t number, const models::Registry& registry,
                const World& world, Problems& problems, std::vector<Place>& places) {
  TableReader reader(node, fmt::format("place[{}]", number), node.line, problems);
  Place place;
  const int model = read_model_name(reader, world, registry);
  if (model < 0) return;
  place.model = static_cast<models::ModelIndex>(model);
  if (reader.read("at_m", place.at_m, kPlacePoints, Presence::kRequired)) {
    const core::WorldPosition at =
        core::normalised({{0, 0}, {place.at_m.x, 0, place.at_m.y}}, world.block_size_m());
    if (!world.contains(at.block))
      reader.problem(reader.find("at_m")->line, "at_m",
                     fmt::format("{:g}, {:g} m is outside the world", place.at_m.x, place.at_m.y));
  }
  visit_placed(place, [&reader](std::string_view key, auto& field, const FieldSpec& spec) {
    reader.read(key, field, {spec.low, spec.high});
  });
  const models::ModelType& type = registry[place.model];
  ModelFields fields = fields_of(type, node.line);
  const auto specs = type.parameters();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    if (specs[i].source == models::ParameterSource::kUser)
      read_parameter(reader, specs[i].name, i, false, fields);
  }
  reader.finish();
  if (!check_model(fields, problems)) return;
  place.parameters = corner_of(fields, 0);
  if (const int seed = models::parameter_index(type, "seed");
      seed >= 0 && specs[static_cast<std::size_t>(seed)].source == models::ParameterSource::kPlaced)
    place.parameters.set_integer(static_cast<std::size_t>(seed), seed_at(world, place.at_m));
  if (type.mesh_size(place.parameters, 0).layout != core::VertexLayout::kModel)
    return reader.problem(reader.find("model")->line, "model", "this model type cannot be placed");
  places.push_back(place);
}

}  // namespace

std::vector<Place> read_places(TableReader& root, const models::Registry& registry,
                               const World& world, Problems& problems) {
  std::vector<Place> places;
  std::size_t number = 0;
  for (const Node* node : root.tables("place", kMaxPlaces))
    read_place(*node, number++, registry, world, problems, places);
  return places;
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

}  // namespace psygen::world
