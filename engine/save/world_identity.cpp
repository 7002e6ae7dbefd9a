#include "engine/save/world_identity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/vec3.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "engine/core/hash.hpp"
#include "engine/core/utf8.hpp"
#include "engine/world/ground_blends.hpp"
#include "engine/world/water.hpp"

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

// Hashes everything that decides where instances stand.
void add_limits(Facts& facts, const world::Scatter& scatter) {
  const world::Scatter usual;
  facts.add("min_height_m", scatter.min_height_m, usual.min_height_m);
  facts.add("max_height_m", scatter.max_height_m, usual.max_height_m);
  facts.add("max_slope_deg", scatter.max_slope_deg, usual.max_slope_deg);
  facts.add("max_depth_m", scatter.max_depth_m, usual.max_depth_m);
  facts.add("near_water_m", scatter.near_water_m, usual.near_water_m);
  if (const std::uint64_t site = world::site_hash(scatter.site); site != 0) facts.add("site", site);
  // A spacing changes which instances stand. Only the first one moves them.
  if (scatter.keeps_apart()) facts.add("keeps_apart");
  if (const std::uint64_t mask = world::mask_hash(scatter.mask); mask != 0) facts.add("mask", mask);
}

void add_scatter(Facts& facts, const models::ModelType& type, const world::Scatter& scatter) {
  facts.add("scatter");
  facts.add(type.name());
  facts.add("count", std::uint64_t{scatter.count});
  add_limits(facts, scatter);
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

void add_colours(Facts& facts, std::initializer_list<glm::vec3> colours) {
  for (const glm::vec3& colour : colours)
    for (int i = 0; i < 3; ++i)
      facts.add("colour", double{colour[i]});
}

// Hashes sky and colours.
void add_looks(Facts& facts, const world::World& world) {
  const world::Sky& sky = world.sky;
  const world::Palette& p = world.palette;
  add_colours(facts, {sky.sun_colour, sky.zenith_colour, sky.horizon_colour, sky.ground_colour,
                      sky.haze_colour, world.water.colour, p.grass, p.forest, p.dry, p.rock, p.snow,
                      p.sand});
  for (const double value :
       {sky.sun_azimuth_deg, sky.sun_elevation_deg, sky.visibility_m, sky.haze_height_m,
        sky.exposure, sky.cloud_cover, sky.day_length_s, sky.start_hour, sky.latitude_deg,
        world.water.shore_m, p.sand_end_m, p.sand_blend_m, p.dry_start_m, p.dry_blend_m,
        p.snow_start_m, p.snow_blend_m, p.rock_slope_start, p.rock_slope_full, p.snow_slope_max})
    facts.add("look", value);
  for (const std::string& image : p.images)
    facts.add(image);
}

// The hash of what add() adds.
template <class Add>
std::uint64_t hash_of(const Add& add) {
  Facts facts;
  add(facts);
  return facts.hash();
}

// Saves of older programs stay valid only if a feature that their worlds lack adds nothing: a new
// shape of the ground, say, is added to kGround if the world has one.
std::vector<WorldPart> parts_of(const world::World& world, const models::Registry& registry) {
  using enum PartKind;
  std::vector<WorldPart> parts;
  const auto part = [&](PartKind kind, const auto& add, std::string_view name = {},
                        std::uint32_t count = 0) {
    parts.push_back({kind, std::string(name), hash_of(add), count});
  };
  part(kSeed, [&](Facts& f) { f.add("seed", world.seed); });
  part(kBlockSize, [&](Facts& f) { f.add("block_m", world.block_size_m()); });
  part(kExtent, [&](Facts& f) {
    f.add("blocks_x", static_cast<std::uint64_t>(world.blocks_x));
    f.add("blocks_z", static_cast<std::uint64_t>(world.blocks_z));
  });
  part(kGround, [&](Facts& f) {
    add_terrain(f, registry[world.terrain_model], world.terrain);
    f.add("shape", world::shape_hash(world));
  });
  part(kWater, [&](Facts& f) {
    if (world.water.exists()) f.add("water", world.water.level_m);
    if (any_acts(world.shaped.lakes)) f.add("lakes", world::bodies_hash(world.shaped.lakes));
    if (any_acts(world.shaped.rivers)) f.add("rivers", world::bodies_hash(world.shaped.rivers));
  });
  for (const world::Scatter& scatter : world.scatter) {
    const std::string_view name = registry[scatter.model].name();
    const auto add = [&](Facts& f) {
      add_limits(f, scatter);
      if (scatter.mask.ground != 0) f.add("ground", world::placing_hash(world));
      if (scatter.limits_depth() || scatter.water_reach_m() > 0)
        f.add("water", world.water.level_m);
      if (scatter.keeps_apart()) return;  // tries one place, so that nothing moves it
      if (scatter.site.asks_for_roads()) f.add("shape", world::shape_hash(world));
      for (const world::Scatter& other : world.scatter) {
        if (!scatter.is_beside() || !other.keeps_apart()) continue;
        add_limits(f, other);
        f.add("count", std::uint64_t{other.count});
        f.add("spacing_m", other.spacing_m);
      }
    };
    part(kScatter, add, name, scatter.count);
  }
  for (const models::Species& species : world.species)
    part(
        kSpecies, [&](Facts& f) { add_species(f, species); }, species.name);
  for (const world::HandmadeModel& model : world.models)
    part(
        kModel, [&](Facts& f) { add_handmade(f, registry, model); }, model.name);
  part(kPlaces, [&](Facts& f) { f.add("places", world::places_hash(world, registry)); });
  part(kLooks, [&](Facts& f) { add_looks(f, world); });
  return parts;
}

std::string_view text_of(PartKind kind) {
  switch (kind) {
    case PartKind::kSeed:
      return "the seed differs, so this is another world";
    case PartKind::kBlockSize:
      return "the blocks have another size";
    case PartKind::kExtent:
      return "the world has another extent";
    case PartKind::kGround:
      return "the ground differs";
    case PartKind::kWater:
      return "the water differs";
    case PartKind::kPlaces:
      return "the single models of the world file differ";
    case PartKind::kLooks:
      return "sky or colours differ";
    case PartKind::kScatter:
      return "scatter";
    case PartKind::kSpecies:
      return "the species";
    case PartKind::kModel:
      return "the model";
  }
  return "";
}

bool is_named(PartKind kind) {
  return kind == PartKind::kSpecies || kind == PartKind::kModel;
}

// The part of this kind and name, or null.
const WorldPart* find(const WorldIdentity& world, const WorldPart& like) {
  const auto found = std::ranges::find_if(world.parts, [&](const WorldPart& part) {
    return part.kind == like.kind && part.name == like.name;
  });
  return found == world.parts.end() ? nullptr : &*found;
}

// The change of one scatter; empty: none.
std::string scatter_change(const WorldPart& part, const ScatterSpan& span, const WorldIdentity& now,
                           const std::vector<ScatterSpan>& spans) {
  const auto same = [&](const ScatterSpan& other) {
    const WorldPart& candidate = now.parts[other.part];
    return candidate.name == part.name && candidate.hash == part.hash;
  };
  const auto is_here = [&](const ScatterSpan& other) {
    return other.first == span.first && now.parts[other.part].name == part.name;
  };
  const auto is_same_here = [&](const ScatterSpan& other) { return is_here(other) && same(other); };
  if (const auto here = std::ranges::find_if(spans, is_same_here); here != spans.end()) {
    if (here->count == span.count) return {};
    return fmt::format("has {} instead of {} models per block", here->count, span.count);
  }
  if (std::ranges::any_of(spans, same)) return "has moved to other indices";
  return std::ranges::any_of(spans, is_here) ? "differs" : "is gone";
}

}  // namespace

std::vector<ScatterSpan> scatter_spans(const WorldIdentity& world) {
  std::vector<ScatterSpan> spans;
  std::uint64_t first = 0;
  for (std::size_t i = 0; i < world.parts.size(); ++i) {
    if (world.parts[i].kind != PartKind::kScatter) continue;
    spans.push_back({i, first, world.parts[i].count});
    first += world.parts[i].count;
  }
  return spans;
}

std::vector<PartChange> changes_between(const WorldIdentity& before, const WorldIdentity& now) {
  std::vector<PartChange> changes;
  if (before.parts.empty() || now.parts.empty()) return changes;
  const auto named = [](const WorldPart& part, std::string_view change) {
    return fmt::format("{} '{}' {}", text_of(part.kind), core::shown(part.name, 60), change);
  };
  for (std::size_t i = 0; i < before.parts.size(); ++i) {
    const WorldPart& part = before.parts[i];
    if (part.kind == PartKind::kScatter) continue;
    const WorldPart* const found = find(now, part);
    if (found != nullptr && found->hash == part.hash) continue;
    std::string text(text_of(part.kind));
    if (is_named(part.kind)) text = named(part, found != nullptr ? "differs" : "is gone");
    changes.push_back({part.kind, i, false, std::move(text)});
  }
  for (std::size_t i = 0; i < now.parts.size(); ++i) {
    const WorldPart& part = now.parts[i];
    if (is_named(part.kind) && find(before, part) == nullptr)
      changes.push_back({part.kind, i, true, named(part, "is new")});
  }
  const std::vector<ScatterSpan> earlier = scatter_spans(before), later = scatter_spans(now);
  const auto scatter = [&](const WorldPart& part, std::size_t k, std::size_t count,
                           std::string_view change) {
    return fmt::format("scatter {} of {} '{}' {}", k + 1, count, core::shown(part.name, 60),
                       change);
  };
  for (std::size_t k = 0; k < earlier.size(); ++k) {
    const WorldPart& part = before.parts[earlier[k].part];
    const std::string change = scatter_change(part, earlier[k], now, later);
    if (!change.empty())
      changes.push_back(
          {part.kind, earlier[k].part, false, scatter(part, k, earlier.size(), change)});
  }
  for (std::size_t k = 0; k < later.size(); ++k) {
    const WorldPart& part = now.parts[later[k].part];
    const std::string change = scatter_change(part, later[k], before, earlier);
    if (change == "is gone")
      changes.push_back({part.kind, later[k].part, true, scatter(part, k, later.size(), "is new")});
  }
  std::ranges::stable_sort(changes, {}, &PartChange::kind);
  return changes;
}

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
  return {world.name, facts.hash(), parts_of(world, registry)};
}

}  // namespace psygen::save
