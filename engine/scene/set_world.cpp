// Replaces the world of a running scene: reuses values derived from the old world, then gives every
// node and model its values in the new one. Old meshes are drawn until the new ones are ready, as
// after any other request.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "engine/core/cancellation.hpp"
#include "engine/scene/facts/derive.hpp"
#include "engine/scene/facts/lighting.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/meshes/mesh_annotations.hpp"
#include "engine/scene/meshes/tree_impostors.hpp"
#include "engine/scene/nodes/edits.hpp"
#include "engine/scene/nodes/entities.hpp"
#include "engine/scene/objects/components.hpp"
#include "engine/scene/state.hpp"
#include "engine/world/far/tree_impostors.hpp"
#include "engine/world/ground_blends.hpp"

namespace psygen::scene {
namespace {

// True if the nodes of both worlds cover the same ground with meshes of the same layout.
bool same_nodes(const WorldFacts& a, const WorldFacts& b) {
  const auto same_level = [](const NodeLevel& x, const NodeLevel& y) {
    return x.size_m == y.size_m && x.mesh_level == y.mesh_level && x.merged == y.merged;
  };
  const auto size_of = [](const WorldFacts& facts) {
    return facts.world.terrain.integer(models::kTerrainSize);
  };
  return a.world.terrain_model == b.world.terrain_model && size_of(a) == size_of(b) &&
         a.cell_m == b.cell_m && a.world.blocks_x == b.world.blocks_x &&
         a.world.blocks_z == b.world.blocks_z && a.tiles.has_value() == b.tiles.has_value() &&
         std::ranges::equal(a.levels, b.levels, same_level);
}

bool same_windows(std::span<const NodeGrid> a, std::span<const NodeGrid> b) {
  return std::ranges::equal(a, b, {}, &NodeGrid::max_radius, &NodeGrid::max_radius);
}

// False if shared indices may belong to another type now.
bool same_types(const models::Registry& a, const models::Registry& b) {
  const std::size_t count = std::min(a.size(), b.size());
  for (models::ModelIndex i = 0; i < count; ++i) {
    if (a[i].name() != b[i].name()) return false;
  }
  return true;
}

// Destroys all nodes; the next tick creates new ones.
void destroy_all_nodes(const WorldFacts& facts, State& s) {
  destroy_nodes(nodes_of(s.entities), s.node_work());
  const auto counts = s.streaming.counts;
  s.streaming = {};
  s.streaming.counts = counts;
  s.streaming.grids = node_grids(s.settings, facts);
  s.draws.cross_fade = {};
}

// Tells how the instances of each scatter stay. Parameters that depend on the ground's slope are
// computed where the slope is known.
std::vector<KeptModels::Stays> stays_of(const DerivedWorldData& before, const WorldFacts& facts) {
  using enum KeptModels::Stays;
  const DerivedWorldData& after = *facts.derived;
  std::vector<KeptModels::Stays> stays(facts.world.scatter.size(), kNothing);
  if (before.types != after.types || before.parts.ground != after.parts.ground) return stays;
  for (std::size_t s = 0; s < std::min(stays.size(), before.parts.places.size()); ++s) {
    if (before.parts.places[s] != after.parts.places[s]) continue;
    const models::ModelType& type = facts.registry[facts.world.scatter[s].model];
    const bool slopes = world::slope_parameters(type) != world::SlopeParameters{-1, -1};
    stays[s] = before.parts.models[s] == after.parts.models[s] ? kAll : slopes ? kNothing : kPlaces;
  }
  return stays;
}

// The models of a scene that stay when the facts `before` are replaced.
KeptModels kept_models(const WorldFacts& before, const WorldFacts& after) {
  KeptModels kept{stays_of(*before.derived, after), {}, {}};
  for (std::size_t s = 0; s < kept.stays.size(); ++s)
    kept.scatter_of.insert(kept.scatter_of.end(), after.world.scatter[s].count,
                           static_cast<std::uint32_t>(s));
  const auto quads = [](const WorldFacts& facts, models::ModelIndex model) {
    const bool has = model < facts.quad_models.size() && facts.quad_models[model] != 0;
    return std::pair(has ? facts.quad_models[model] : models::ModelIndex{0},
                     has ? facts.pictures->identity_of_quads(model) : 0);
  };
  // The types of models on blocks; registries also hold those of objects.
  const std::size_t types = std::min(before.typical_bounds.size(), after.typical_bounds.size());
  for (models::ModelIndex model = 0; model < types; ++model)
    kept.refit.push_back(before.typical_bounds[model] != after.typical_bounds[model] ||
                         quads(before, model) != quads(after, model));
  return kept;
}

// `kept`: null: none.
void update_all_nodes(PreparedWorld& prepared, const KeptModels* kept, State& s) {
  std::vector<world::Placement> scratch;
  for (const ecs::Entity node : nodes_of(s.entities)) {
    const visibility::NodeCoord at = s.entities.get<QuadtreeNode>(node)->at;
    const auto models = at.level == 0 ? prepared.models.find(at.coord) : prepared.models.end();
    const bool known = models != prepared.models.end();
    if (known) scratch = std::move(models->second);
    const NodeChange change{
        .ground = kept == nullptr, .world = true, .placed = known, .kept = kept};
    update_node(s.facts, s.daylight, node, change, scratch, s.node_work());
  }
}

world::World without_edits(world::World world) {
  world::set_edits(world, nullptr);
  return world;
}

// The types that came with a world.
models::Registry without_own_types(WorldFacts& facts) {
  models::Registry registry = std::move(facts.registry);
  registry.shrink(facts.given_types);
  return registry;
}

// True if worlds without edits differ in nothing that meshes or places depend on.
bool same_but_looks(world::World a, const world::World& b) {
  if (world::placing_hash(a) != world::placing_hash(b)) return false;
  const auto asks_for_water = [](const world::Scatter& scatter) {
    return scatter.limits_depth() || scatter.water_reach_m() > 0;
  };
  if (a.water.level_m != b.water.level_m && std::ranges::any_of(a.scatter, asks_for_water))
    return false;
  a.name = b.name;
  a.sky = b.sky;
  a.water = b.water;
  a.palette = b.palette;
  return a == b;
}

// Replaces the sky. daylight_system() updates sun and shadows.
void replace_sky(const world::Sky& sky, State& s) {
  s.facts.world.sky = sky;
  s.facts.light = light_of(s.facts.world, s.settings.view_distance_m);
}

bool same_looks(const world::World& a, const world::World& b) {
  return a.name == b.name && a.sky == b.sky && a.water == b.water && a.palette == b.palette;
}

WorldChanged change_between(const WorldFacts& before, const WorldFacts& after) {
  const DerivedWorldData &a = *before.derived, &b = *after.derived;
  const world::World &from = before.world, &to = after.world;
  return {.ground = a.parts.ground != b.parts.ground,
          .models = a.types != b.types || a.parts != b.parts || from.species != to.species ||
                    from.models != to.models || from.places != to.places,
          .looks = !same_looks(from, to),
          .block_m_before = from.block_size_m()};
}

// Keeps the places of entities and requested places when blocks get another size.
void resize_blocks(double before_m, State& s) {
  const double block_m = s.facts.world.block_size_m();
  if (block_m == before_m) return;
  s.entities.each<Transform>([&](auto, std::span<Transform> transforms) {
    for (Transform& transform : transforms) {
      if (core::is_finite(transform.position.local))
        transform.position = world::rebased(transform.position, before_m, block_m);
    }
  });
  for (RequestedPlace& place : s.meshes.places.places)
    place.position = world::rebased(place.position, before_m, block_m);
}

void replace_looks(const world::World& world, State& s) {
  WorldFacts& facts = s.facts;
  ++facts.world.revision.number;
  facts.world.name = world.name;
  facts.world.water = world.water;
  facts.world.palette = world.palette;
  facts.palette = palette_of(facts.world);
  replace_sky(world.sky, s);
}

bool is_usable(const world::Sky& sky) {
  const double numbers[] = {sky.sun_azimuth_deg, sky.sun_elevation_deg, sky.cloud_cover,
                            sky.day_length_s,    sky.start_hour,        sky.latitude_deg};
  const double positive[] = {sky.visibility_m, sky.haze_height_m, sky.exposure};
  const glm::vec3 colours[] = {sky.sun_colour, sky.zenith_colour, sky.horizon_colour,
                               sky.ground_colour, sky.haze_colour};
  return std::ranges::all_of(numbers, [](double v) { return std::isfinite(v); }) &&
         std::ranges::all_of(positive, [](double v) { return std::isfinite(v) && v > 0; }) &&
         std::ranges::all_of(colours, [](const glm::vec3& c) { return core::is_finite(c); });
}

// A world takes over the heights that the last one has kept, and patches of the same network: the
// keys name all that they depend on (terrain/ground.cpp), and they take seconds to make.
void keep_caches(const world::World& before, world::World& world) {
  if (!before.shaped.layer || !world.shaped.layer) return;
  const models::GroundStack& known = before.shaped.layer->ground;
  models::EditLayer layer = *world.shaped.layer;  // O(1)
  if (!layer.ground.has_fixed_part() || !known.has_fixed_part()) return;
  layer.ground.heights = known.heights;
  if (layer.ground.network && known.network &&
      layer.ground.network->identity() == known.network->identity())
    layer.ground.network = known.network;
  world.shaped.layer = std::make_shared<const models::EditLayer>(std::move(layer));
}

}  // namespace

core::Result<PreparedWorld> prepare_world(world::World world, models::Registry registry,
                                          const SceneSnapshot& snapshot) {
  PreparedWorld prepared;
  WorldFacts& facts = prepared.facts;
  keep_caches(snapshot.world, world);
  world::set_edits(world, nullptr);
  prepared.looks_only = same_but_looks(world, snapshot.world);
  facts.world = std::move(world);
  facts.registry = std::move(registry);
  if (prepared.looks_only) return prepared;
  prepared.before = snapshot.derived;
  if (auto ok = derive(snapshot.settings, true, facts, prepared.before.get()); !ok)
    return tl::unexpected(ok.error());
  if (auto ok = core::check_cancelled(); !ok) return tl::unexpected(ok.error());
  facts.typical_bounds = typical_bounds(facts.registry, models_on(facts, {}));
  const std::vector<bool> wanted =
      prepared.before ? KeptModels{stays_of(*prepared.before, facts), {}, {}}.wanted()
                      : std::vector<bool>(facts.world.scatter.size(), true);
  for (const core::BlockCoord block : snapshot.blocks) {
    if (auto ok = core::check_cancelled(); !ok) return tl::unexpected(ok.error());
    world::place_models(facts.world, facts.registry, block, wanted, prepared.models[block]);
  }
  const models::RiverNetwork* const network = facts.world.network();
  if (network == nullptr || network == snapshot.world.network()) return prepared;
  // Makes the patches of coarse nodes, which the main thread will read.
  for (const visibility::NodeCoord& node : snapshot.nodes) {
    for (const auto& tile : models::ground_patches(node_terrain(facts.world, node))) {
      if (auto ok = core::check_cancelled(); !ok) return tl::unexpected(ok.error());
      static_cast<void>(network->patch(tile));
    }
  }
  return prepared;
}

SceneSnapshot Scene::snapshot() const {
  const WorldFacts& facts = state_->facts;
  SceneSnapshot snapshot{
      state_->settings, facts.world, {}, {}, facts.world.edits ? nullptr : facts.derived};
  world::set_edits(snapshot.world, nullptr);
  state_->entities.each<const QuadtreeNode>([&](auto, auto nodes) {
    for (const QuadtreeNode& node : nodes) {
      if (node.at.level == 0)
        snapshot.blocks.push_back(node.at.coord);
      else
        snapshot.nodes.push_back(node.at);
    }
  });
  return snapshot;
}

core::Result<void> Scene::set_world(world::World world, models::Registry registry) {
  auto prepared = prepare_world(std::move(world), std::move(registry), snapshot());
  if (!prepared) return tl::unexpected(prepared.error());
  return set_world(std::move(*prepared));
}

core::Result<void> Scene::set_world(PreparedWorld prepared) {
  State& s = *state_;
  WorldFacts& next = prepared.facts;
  // The scene may have changed since the snapshot.
  if (prepared.looks_only && !same_but_looks(next.world, without_edits(s.facts.world)))
    return set_world(std::move(next.world), std::move(next.registry));
  const bool other = prepared.before && (prepared.before != s.facts.derived || s.facts.world.edits);
  if (other) return set_world(std::move(next.world), without_own_types(next));
  if (prepared.looks_only) {
    const WorldChanged change{.looks = !same_looks(next.world, s.facts.world),
                              .block_m_before = next.world.block_size_m()};
    replace_looks(next.world, s);
    s.events.world_changed.emit(change);
    return {};
  }
  if (!show_stand_ins(next, s.facts.pictures.get(), s.meshes, s.output)) {
    if (auto ok = derive(s.settings, false, next); !ok) return ok;
    next.typical_bounds = typical_bounds(next.registry, models_on(next, {}));
    prepared.models.clear();  // without pictures other things stay
    prepared.before = nullptr;
  }
  const bool rested = s.supply.quiesce();
  forget_pictures(s.facts, s.supply);
  // Nothing fails from here on: the same types were added before.
  if (auto ok = s.assets.follow(next.registry); !ok) return ok;
  const bool same =
      same_nodes(s.facts, next) && same_windows(s.streaming.grids, node_grids(s.settings, next));
  if (!same || !same_types(s.facts.registry, next.registry)) s.meshes.shared_indices.clear();
  if (!same) destroy_all_nodes(next, s);
  const bool same_ground = same && prepared.before &&
                           prepared.before->types == next.derived->types &&
                           prepared.before->parts.ground == next.derived->parts.ground;
  const auto kept = same_ground ? std::optional(kept_models(s.facts, next)) : std::nullopt;
  const WorldChanged change = change_between(s.facts, next);
  next.world.revision.number = s.facts.world.revision.number + 1;
  std::swap(s.facts, next);
  if (!rested || s.assets.mesh_count() > 0) s.retired_types.push_back(std::move(next.registry));
  s.supply.adopt_types(mesh_annotations(s.facts));
  s.supply.set_edits(s.facts.world.layer());
  on_preset_changed();
  name_types(s.facts.registry, s.trace);
  resize_blocks(change.block_m_before, s);
  if (same) update_all_nodes(prepared, kept ? &*kept : nullptr, s);
  // Fixed steps of the next tick come before its system "edits".
  edit(std::move(s.pending_edits.edits));
  edits_system(s.daylight, s.pending_edits, s.facts, s.node_work());
  for (RequestedPlace& place : s.meshes.places.places)
    place.stale = true;
  s.events.world_changed.emit(change);
  return {};
}

core::Result<void> Scene::set_sky(const world::Sky& sky) {
  if (!is_usable(sky))
    return core::invalid_argument(
        "a sky has finite numbers, and visibility, haze height and exposure above 0");
  replace_sky(sky, *state_);
  return {};
}

}  // namespace psygen::scene
