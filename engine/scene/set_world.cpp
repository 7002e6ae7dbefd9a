// Replaces the world of a running scene: takes over what is derived from the new one, then gives
// every node and model what it is there. What is drawn stays until the new meshes are there; that
// is synthesis like any other.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/scene/cost_samples.hpp"
#include "engine/scene/draws/lighting.hpp"
#include "engine/scene/mesh_notes.hpp"
#include "engine/scene/nodes/entities.hpp"
#include "engine/scene/nodes/usual_boxes.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/tree_pictures.hpp"
#include "engine/scene/world_facts.hpp"
#include "engine/world/far/tree_pictures.hpp"
#include "engine/world/ground_blends.hpp"

namespace psygen::scene {
namespace {

// Whether nodes of both worlds are the same pieces of ground with meshes of the same layout.
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

// Types whose shared indices may be those of another type now.
bool same_types(const models::Registry& a, const models::Registry& b) {
  const std::size_t count = std::min(a.size(), b.size());
  for (models::ModelIndex i = 0; i < count; ++i) {
    if (a[i].name() != b[i].name()) return false;
  }
  return true;
}

std::vector<ecs::Entity> nodes_of(const ecs::World& entities) {
  std::vector<ecs::Entity> nodes;
  entities.each<const Node>([&](std::span<const ecs::Entity> rows, std::span<const Node>) {
    nodes.insert(nodes.end(), rows.begin(), rows.end());
  });
  return nodes;
}

// They are created anew in the next tick.
void destroy_all_nodes(const WorldFacts& facts, State& s) {
  destroy_nodes(nodes_of(s.entities), s.meshes, s.entities, s.events.removed);
  s.streaming = {};
  s.streaming.grids = node_grids(s.settings, facts);
  s.draws.handover = {};
}

// What stays of the instances of each scatter. Parameters that depend on the ground's slope are
// drawn where it is known.
std::vector<KeptModels::Stays> what_stays(const Derived& before, const WorldFacts& facts) {
  using enum KeptModels::Stays;
  const Derived& after = *facts.derived;
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

// What stays of a scene's models when the facts `before` are replaced.
KeptModels kept_models(const WorldFacts& before, const WorldFacts& after) {
  KeptModels kept{what_stays(*before.derived, after), {}, {}};
  for (std::size_t s = 0; s < kept.stays.size(); ++s)
    kept.scatter_of.insert(kept.scatter_of.end(), after.world.scatter[s].count,
                           static_cast<std::uint32_t>(s));
  const auto quads = [](const WorldFacts& facts, models::ModelIndex model) {
    const bool has = model < facts.quad_models.size() && facts.quad_models[model] != 0;
    return std::pair(has ? facts.quad_models[model] : models::ModelIndex{0},
                     has ? facts.pictures->identity_of_quads(model) : 0);
  };
  // The types that can stand on a block; registries also have those of objects.
  const std::size_t types = std::min(before.usual_boxes.size(), after.usual_boxes.size());
  for (models::ModelIndex model = 0; model < types; ++model)
    kept.refit.push_back(before.usual_boxes[model] != after.usual_boxes[model] ||
                         quads(before, model) != quads(after, model));
  return kept;
}

// `kept`: null: nothing.
void update_all_nodes(PreparedWorld& prepared, const KeptModels* kept, State& s) {
  std::vector<world::Placement> scratch;
  for (const ecs::Entity node : nodes_of(s.entities)) {
    const visibility::NodeCoord at = s.entities.get<Node>(node)->at;
    const auto models = at.level == 0 ? prepared.models.find(at.coord) : prepared.models.end();
    const bool known = models != prepared.models.end();
    if (known) scratch = std::move(models->second);
    const NodeChange change{
        .ground = kept == nullptr, .world = true, .placed = known, .kept = kept};
    update_node(s.facts, s.daylight, node, change, scratch, s.meshes, s.entities,
                {s.events.created, s.events.removed});
  }
}

world::World without_edits(world::World world) {
  world::set_edits(world, nullptr);
  return world;
}

// The types that a world came with.
models::Registry without_own_types(WorldFacts& facts) {
  models::Registry registry = std::move(facts.registry);
  registry.shrink(facts.given_types);
  return registry;
}

// Whether worlds without edits differ in nothing that meshes or places depend on.
bool same_but_looks(world::World a, const world::World& b) {
  if (world::placing_hash(a) != world::placing_hash(b)) return false;
  a.name = b.name;
  a.sky = b.sky;
  a.water = b.water;
  a.palette = b.palette;
  return a == b;
}

// Sun and shadows follow by themselves (daylight_system).
void take_over_sky(const world::Sky& sky, State& s) {
  s.facts.world.sky = sky;
  s.facts.light = light_of(s.facts.world, s.settings.view_distance_m);
}

void take_over_looks(const world::World& world, State& s) {
  WorldFacts& facts = s.facts;
  facts.world.name = world.name;
  facts.world.water = world.water;
  facts.world.palette = world.palette;
  facts.palette = palette_of(facts.world);
  take_over_sky(world.sky, s);
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

void name_types(const models::Registry& registry, Tracing& trace) {
  if (trace.log == nullptr) return;
  trace.models.clear();
  for (models::ModelIndex i = 0; i < registry.size(); ++i)
    trace.models.push_back(trace.log->intern(registry[i].name()));
}

}  // namespace

core::Result<PreparedWorld> prepare_world(world::World world, models::Registry registry,
                                          const SceneSnapshot& snapshot) {
  PreparedWorld prepared;
  WorldFacts& facts = prepared.facts;
  world::set_edits(world, nullptr);
  prepared.looks_only = same_but_looks(world, snapshot.world);
  facts.world = std::move(world);
  facts.registry = std::move(registry);
  if (prepared.looks_only) return prepared;
  prepared.before = snapshot.derived;
  if (auto ok = derive(snapshot.settings, true, facts, prepared.before.get()); !ok)
    return tl::unexpected(ok.error());
  facts.usual_boxes = usual_boxes(facts.registry, models_on(facts, {}));
  const std::vector<bool> wanted =
      prepared.before ? KeptModels{what_stays(*prepared.before, facts), {}, {}}.wanted()
                      : std::vector<bool>(facts.world.scatter.size(), true);
  for (const core::BlockCoord block : snapshot.blocks)
    world::place_models(facts.world, facts.registry, block, wanted, prepared.models[block]);
  return prepared;
}

SceneSnapshot Scene::snapshot() const {
  const WorldFacts& facts = state_.facts;
  SceneSnapshot snapshot{
      state_.settings, facts.world, {}, facts.world.edits ? nullptr : facts.derived};
  world::set_edits(snapshot.world, nullptr);
  state_.entities.each<const Node>([&](std::span<const ecs::Entity>, std::span<const Node> nodes) {
    for (const Node& node : nodes) {
      if (node.at.level == 0) snapshot.blocks.push_back(node.at.coord);
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
  State& s = state_;
  WorldFacts& next = prepared.facts;
  // The scene may have changed since the snapshot.
  if (prepared.looks_only && !same_but_looks(next.world, without_edits(s.facts.world)))
    return set_world(std::move(next.world), std::move(next.registry));
  const bool other = prepared.before && (prepared.before != s.facts.derived || s.facts.world.edits);
  if (other) return set_world(std::move(next.world), without_own_types(next));
  if (prepared.looks_only) {
    take_over_looks(next.world, s);
    return {};
  }
  if (!show_stand_ins(next, s.facts.pictures.get(), s.output)) {
    if (auto ok = derive(s.settings, false, next); !ok) return ok;
    next.usual_boxes = usual_boxes(next.registry, models_on(next, {}));
    prepared.models.clear();  // without pictures other things stay
    prepared.before = nullptr;
  }
  const bool rested = s.meshes.come_to_rest();
  forget_pictures(s.facts, s.meshes);
  // Nothing fails from here on: the same types were added before.
  if (auto ok = s.assets.follow(next.registry); !ok) return ok;
  const bool same =
      same_nodes(s.facts, next) && same_windows(s.streaming.grids, node_grids(s.settings, next));
  if (!same || !same_types(s.facts.registry, next.registry)) s.output.shared_indices.clear();
  if (!same) destroy_all_nodes(next, s);
  const bool same_ground = same && prepared.before &&
                           prepared.before->types == next.derived->types &&
                           prepared.before->parts.ground == next.derived->parts.ground;
  const auto kept = same_ground ? std::optional(kept_models(s.facts, next)) : std::nullopt;
  std::swap(s.facts, next);
  if (!rested || s.assets.mesh_count() > 0) retired_types_.push_back(std::move(next.registry));
  s.meshes.take_over_types(mesh_notes(s.facts));
  s.meshes.set_edits(s.facts.world.layer());
  take_over_preset();
  name_types(s.facts.registry, s.trace);
  edit(std::move(s.editing.edits));
  if (same) update_all_nodes(prepared, kept ? &*kept : nullptr, s);
  for (Foresight::Place& place : s.foresight.places)
    place.stale = true;
  return {};
}

core::Result<void> Scene::set_sky(const world::Sky& sky) {
  if (!is_usable(sky))
    return core::fail(core::ErrorCode::kInvalidArgument,
                      "a sky has finite numbers, and visibility, haze height and exposure above 0");
  take_over_sky(sky, state_);
  return {};
}

}  // namespace psygen::scene
