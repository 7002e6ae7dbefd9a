#include "engine/save/world_identity.hpp"

#include <bit>
#include <cmath>
#include <span>
#include <string_view>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/world/ground_blends.hpp"

namespace psygen::save {
namespace {

// A hash of named values. Default values do not contribute.
class Facts {
 public:
  void add(std::string_view text) {
    mix(core::hash_bytes(std::as_bytes(std::span(text)), text.size()));
  }
  void add(std::string_view name, std::uint64_t value) {
    add(name);
    mix(value);
  }
  void add(std::string_view name, double value) {
    add(name, std::bit_cast<std::uint64_t>(value + 0.0));  // −0 is 0
  }
  void add(std::string_view name, double value, double usual) {
    if (value != usual) add(name, value);
  }
  std::uint64_t hash() const { return hash_; }

 private:
  void mix(std::uint64_t value) { hash_ = core::combine(hash_, value); }
  std::uint64_t hash_ = 0;
};

// Hashes the numbers that visit() visits, with their names.
template <class Visit>
void add_numbers(Facts& facts, const Visit& visit) {
  std::vector<double> usual;
  visit(true,
        [&](std::string_view, double value, const models::NumberSpec&) { usual.push_back(value); });
  std::size_t i = 0;
  visit(false, [&](std::string_view name, double value, const models::NumberSpec&) {
    facts.add(name, value, usual[i++]);
  });
}

void add_terrain(Facts& facts, const models::ModelType& type, const models::Parameters& p) {
  facts.add(type.name());
  const auto specs = type.parameters();
  for (std::size_t i = 0; i < specs.size(); ++i) {
    if (specs[i].source == models::ParameterSource::kPlaced) continue;
    const bool whole = specs[i].type == models::ParameterType::kInteger;
    facts.add(specs[i].name, whole ? static_cast<double>(p.integer(i)) : p.real(i),
              specs[i].default_value);
  }
}

void add_scatter(Facts& facts, const models::ModelType& type, const world::Scatter& scatter) {
  const world::Scatter usual;
  facts.add("scatter");
  facts.add(type.name());
  facts.add("count", std::uint64_t{scatter.count});
  facts.add("min_height_m", scatter.min_height_m, usual.min_height_m);
  facts.add("max_height_m", scatter.max_height_m, usual.max_height_m);
  facts.add("max_slope_deg", scatter.max_slope_deg, usual.max_slope_deg);
  if (const std::uint64_t mask = world::mask_hash(scatter.mask); mask != 0) facts.add("mask", mask);
  const auto specs = type.parameters();
  for (std::size_t i = 0; i < scatter.ranges.size(); ++i) {
    const auto [low, high] = scatter.ranges[i];
    if (specs[i].source == models::ParameterSource::kPlaced) continue;
    if (low == high && low == specs[i].default_value) continue;
    facts.add(specs[i].name, low);
    facts.add("to", high);
  }
}

// Hashes name and shape of a handmade model. The identity of its type covers the file.
void add_handmade(Facts& facts, const models::Registry& registry,
                  const world::HandmadeModel& model) {
  facts.add("model");
  facts.add(model.name);
  if (const int index = registry.find(model.name); index >= 0)
    facts.add("shape", registry[static_cast<models::ModelIndex>(index)].identity());
}

// Hashes the branches of a species. Leaves and colours do not matter.
void add_species(Facts& facts, models::Species species) {
  const models::Species usual;
  species.colour_variation = usual.colour_variation;
  facts.add("species");
  facts.add(species.name);
  facts.add(species.axiom);
  facts.add("iterations", static_cast<std::uint64_t>(species.iterations));
  facts.add("branches", static_cast<std::uint64_t>(species.branches));
  facts.add("spread", static_cast<std::uint64_t>(species.spread));
  add_numbers(facts, [&](bool of_usual, const auto& visit) {
    models::visit_numbers(of_usual ? usual : species, visit);
  });
  for (const models::SpeciesKind& kind : species.kinds) {
    facts.add(kind.leader ? "leader" : "kind");
    facts.add(kind.symbol);
    add_numbers(facts, [&, none = models::SpeciesKind()](bool of_usual, const auto& visit) {
      models::visit_kind_numbers(of_usual ? none : kind, visit);
    });
  }
  for (const models::SpeciesRule& rule : species.rules) {
    facts.add(rule.from);
    facts.add(rule.to);
    facts.add("probability", rule.probability);
  }
}

}  // namespace

WorldIdentity identity_of(const world::World& world, const models::Registry& registry) {
  Facts facts;
  facts.add("seed", world.seed);
  facts.add("blocks_x", static_cast<std::uint64_t>(world.blocks_x));
  facts.add("blocks_z", static_cast<std::uint64_t>(world.blocks_z));
  if (world.water.exists()) facts.add("water", world.water.level_m);
  add_terrain(facts, registry[world.terrain_model], world.terrain);
  for (const models::Species& species : world.species)
    add_species(facts, species);
  for (const world::HandmadeModel& model : world.models)
    add_handmade(facts, registry, model);
  for (const world::Scatter& scatter : world.scatter)
    add_scatter(facts, registry[scatter.model], scatter);
  if (const std::uint64_t shape = world::shape_hash(world); shape != 0) facts.add("shape", shape);
  if (const std::uint64_t places = world::places_hash(world, registry); places != 0)
    facts.add("places", places);
  if (const std::uint64_t ground = world::placing_hash(world); ground != 0)
    facts.add("ground", ground);
  return {world.name, facts.hash()};
}

}  // namespace psygen::save
