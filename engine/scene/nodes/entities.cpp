#include "engine/scene/nodes/entities.hpp"

#include <algorithm>
#include <optional>

#include "engine/scene/facts/levels.hpp"
#include "engine/scene/facts/solidity.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/nodes/daylight.hpp"
#include "engine/scene/nodes/ground_occluder.hpp"
#include "engine/scene/nodes/ground_sunlight.hpp"
#include "engine/scene/nodes/mesh_entity.hpp"
#include "engine/world/far/merged_models.hpp"

namespace psygen::scene {
namespace {

template <class Created>
void fill(const Created& created, std::size_t i, const MeshColumns& columns) {
  created.template column<MeshPlacement>()[i] = columns.placed;
  created.template column<LodErrors>()[i] = columns.detail;
  created.template column<MeshSource>()[i] = columns.source;
}

// Creates mesh entities with the common components and `Also`.
template <class... Also>
std::span<const ecs::Entity> create_meshes(const WorldFacts& facts, core::BlockCoord block,
                                           std::span<const world::Placement> placements,
                                           ecs::World& entities, bool added = false) {
  const auto models =
      entities.create<MeshPlacement, LodErrors, MeshSource, MeshDemand, Mesh, Fading, Also...>(
          placements.size());
  for (std::size_t i = 0; i < placements.size(); ++i) {
    fill(models, i, columns_of(facts, block, placements[i]));
    models.template column<MeshDemand>()[i].added = added;
  }
  return models.entities;
}

void tell_created(std::span<const ecs::Entity> models, core::BlockCoord block,
                  std::span<const world::Placement> placements,
                  ecs::EventQueue<ModelCreated>& created) {
  if (!created.has_readers()) return;
  std::vector<ModelCreated> events;
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (placements[i].index == kWaterIndex) continue;
    events.push_back({models[i], block, placements[i].index, placements[i].model});
  }
  created.emit(events);
}

// Lists the meshes of a coarse node: its water and its merged mesh, by growing index.
void list_meshes(const WorldFacts& facts, const visibility::NodeCoord& at,
                 std::vector<world::Placement>& out) {
  out.clear();
  if (auto water = water_placement(facts, at)) out.push_back(*water);
  if (has_merged(facts, at)) out.push_back(merged_placement(facts, at));
}

// Creates a mesh of a coarse node. `added`: by an edit.
ecs::Entity create_mesh(const WorldFacts& facts, core::BlockCoord block,
                        const world::Placement& placement, ecs::World& entities, bool added) {
  const std::span<const world::Placement> one(&placement, 1);
  return placement.index == kWaterIndex
             ? create_meshes(facts, block, one, entities, added)[0]
             : create_meshes<MeshParts, ReplacedParts>(facts, block, one, entities, added)[0];
}

// Lists the models of a block that a world places, and the surface of its water.
void list_models(const WorldFacts& facts, const visibility::NodeCoord& at,
                 std::vector<world::Placement>& out) {
  world::place_models(facts.world, facts.registry, visibility::corner_block(at), out);
  if (auto water = water_placement(facts, at)) out.push_back(*water);
}

// Creates the meshes of a node beside its ground: the models of a block, the merged mesh of a
// coarser node, and water.
void create_models(const WorldFacts& facts, const visibility::NodeCoord& at, ecs::Entity node,
                   std::vector<world::Placement>& scratch, ecs::World& entities,
                   ecs::EventQueue<ModelCreated>& created) {
  const core::BlockCoord block = visibility::corner_block(at);
  if (at.level == 0) {
    list_models(facts, at, scratch);
    const std::span<const ecs::Entity> models = create_meshes(facts, block, scratch, entities);
    entities.set_children(node, models);
    tell_created(models, block, scratch, created);
    return;
  }
  list_meshes(facts, at, scratch);
  std::vector<ecs::Entity> meshes;
  for (const world::Placement& placement : scratch)
    meshes.push_back(create_mesh(facts, block, placement, entities, false));
  entities.set_children(node, meshes);
}

MeshColumns ground_columns(const WorldFacts& facts, const Daylight& daylight,
                           const visibility::NodeCoord& at) {
  const int level = facts.levels[at.level].mesh_level;
  return columns_of(
      facts, visibility::corner_block(at),
      {facts.world.terrain_model, kTerrainIndex, glm::vec3(0.0F), lit_ground(facts, daylight, at)},
      at.level == 0 ? 0 : level, level);
}

// Marks the drawn mesh as stale unless it has the entity's present parameters and impostors. After
// an edit is taken back, the old mesh may still be drawn.
void note_stale(ecs::Entity entity, const synthesis::MeshSupply& meshes, ecs::World& entities) {
  MeshDemand& demand = *entities.get<MeshDemand>(entity);
  const synthesis::MeshRecord* drawn = meshes.ready(entities.get<Mesh>(entity)->handle);
  const MeshSource& source = *entities.get<MeshSource>(entity);
  const bool right = drawn != nullptr &&
                     drawn->key.model == (demand.pictured ? source.picture_model : source.model) &&
                     drawn->key.parameters_hash == hash_of(source, demand.pictured);
  demand.stale = demand.drawn_level != kNoLevel && !right;
}

// Sets the parameters of an entity. Returns true if they give another mesh.
bool renew(const models::Parameters& parameters, const WorldFacts& facts, ecs::Entity entity,
           const synthesis::MeshSupply& meshes, ecs::World& entities) {
  MeshSource& source = *entities.get<MeshSource>(entity);
  const std::uint64_t hash = models::parameters_hash(facts.registry[source.model], parameters);
  const bool other = source.parameters_hash != hash || source.parameters != parameters;
  source.parameters = parameters;  // refers to another edit layer in any case
  if (!other) return false;
  source.parameters_hash = hash;
  MeshDemand& demand = *entities.get<MeshDemand>(entity);
  note_stale(entity, meshes, entities);
  demand.requested_level = kNoLevel;
  demand.failed_levels = 0;
  return true;
}

void place_anew(const WorldFacts& facts, core::BlockCoord block, const world::Placement& placement,
                bool world, ecs::Entity entity, const synthesis::MeshSupply& meshes,
                ecs::World& entities) {
  // Merged mesh types follow the species in the registry, so their index moves with them.
  entities.get<MeshSource>(entity)->model = placement.model;
  if (!renew(placement.parameters, facts, entity, meshes, entities) && !world) {
    entities.get<MeshPlacement>(entity)->position = placement.position;
    return;
  }
  const MeshColumns columns = columns_of(facts, block, placement);
  *entities.get<MeshPlacement>(entity) = columns.placed;
  *entities.get<LodErrors>(entity) = columns.detail;
  entities.get<MeshSource>(entity)->picture_model = columns.source.picture_model;
  entities.get<MeshSource>(entity)->picture_set = columns.source.picture_set;
  if (!world) return;
  entities.get<MeshDemand>(entity)->requested_level = kNoLevel;  // no request is left
  note_stale(entity, meshes, entities);
}

void destroy_models(std::span<const ecs::Entity> models, synthesis::MeshSupply& meshes,
                    ecs::World& entities, ecs::EventQueue<ModelRemoved>& removed) {
  std::vector<ModelRemoved> events;
  for (const ecs::Entity model : models) {
    if (entities.get<MeshDemand>(model)->drawn_level != kNoLevel)
      meshes.rank(entities.get<Mesh>(model)->handle, synthesis::Rank::unwanted());
    const MeshSource& source = *entities.get<MeshSource>(model);
    if (source.index == kWaterIndex) continue;
    events.push_back(
        {model, entities.get<MeshPlacement>(model)->block, source.index, source.model});
  }
  if (removed.has_readers()) removed.emit(events);
  entities.destroy(models);
}

// Makes parameters whose mesh did not change refer to the world's present edit layer.
void follow_layer(const WorldFacts& facts, models::Parameters& parameters) {
  if (parameters.edits() != nullptr)
    parameters.set_edits(facts.world.layer().get(), parameters.edits_hash());
}

// Renews the meshes of a coarse node beside its ground after a change.
void update_meshes(const WorldFacts& facts, const visibility::NodeCoord& at,
                   const NodeChange& change, ecs::Entity node,
                   std::vector<world::Placement>& scratch, const NodeWork& work) {
  ecs::World& entities = work.entities;
  if (!change.ground && !change.models && !change.world) {
    for (const ecs::Entity mesh : entities.children(node))
      follow_layer(facts, entities.get<MeshSource>(mesh)->parameters);
    return;
  }
  const core::BlockCoord block = visibility::corner_block(at);
  list_meshes(facts, at, scratch);
  const std::span<const ecs::Entity> now = entities.children(node);
  const std::vector<ecs::Entity> before(now.begin(), now.end());
  std::vector<ecs::Entity> kept, gone;
  for (const ecs::Entity mesh : before) {
    const std::uint32_t index = entities.get<MeshSource>(mesh)->index;
    const auto placement = std::ranges::find(scratch, index, &world::Placement::index);
    if (placement == scratch.end()) {
      gone.push_back(mesh);
      continue;
    }
    kept.push_back(mesh);
    if (change.ground || change.models) {
      place_anew(facts, block, *placement, change.world, mesh, work.supply, entities);
    } else {
      follow_layer(facts, entities.get<MeshSource>(mesh)->parameters);
    }
    scratch.erase(placement);
  }
  if (gone.empty() && scratch.empty()) return;
  for (const ecs::Entity mesh : gone) {
    if (entities.get<MeshDemand>(mesh)->drawn_level != kNoLevel)
      work.supply.rank(entities.get<Mesh>(mesh)->handle, synthesis::Rank::unwanted());
  }
  entities.destroy(gone);
  for (const world::Placement& placement : scratch)
    kept.push_back(create_mesh(facts, block, placement, entities, !change.world));
  std::ranges::sort(kept, {},
                    [&](ecs::Entity mesh) { return entities.get<MeshSource>(mesh)->index; });
  entities.set_children(node, kept);
}

// Fits bounds and levels of a node's ground to the world that replaced another one.
void fit_ground(const WorldFacts& facts, const Daylight& daylight, ecs::Entity node,
                ecs::World& entities) {
  const MeshColumns columns = ground_columns(facts, daylight, entities.get<QuadtreeNode>(node)->at);
  *entities.get<MeshPlacement>(node) = columns.placed;
  *entities.get<LodErrors>(node) = columns.detail;
  entities.get<MeshDemand>(node)->requested_level = kNoLevel;
}

// Updates instances of a block that stay when a world is replaced.
class StayingModels {
 public:
  // `kept`: null: no instance stays.
  StayingModels(const WorldFacts& facts, core::BlockCoord block, const KeptModels* kept)
      : facts_(facts), block_(block), kept_(kept), obstacles_(facts.world, block) {}

  // Returns false for an instance that must be placed again.
  bool take(ecs::Entity model, const synthesis::MeshSupply& meshes, ecs::World& entities) {
    const MeshSource& source = *entities.get<MeshSource>(model);
    if (kept_ == nullptr || source.index >= kept_->scatter_of.size()) return false;
    const std::uint32_t scatter = kept_->scatter_of[source.index];
    const KeptModels::Stays stays = kept_->stays[scatter];
    if (stays == KeptModels::Stays::kNothing) return false;
    world::Placement placed{source.model, source.index,
                            entities.get<MeshPlacement>(model)->position, source.parameters};
    if (stays == KeptModels::Stays::kPlaces)
      placed.parameters = scattering(scatter).parameters(source.index);
    if (stays == KeptModels::Stays::kPlaces || kept_->refit[source.model])
      place_anew(facts_, block_, placed, true, model, meshes, entities);
    return true;
  }

 private:
  const world::Scattering& scattering(std::uint32_t number) {
    if (!scattering_ || number_ != number) {
      const world::Scatter& scatter = facts_.world.scatter[number];
      scattering_.emplace(facts_.world, facts_.registry[scatter.model], scatter, obstacles_);
      number_ = number;
    }
    return *scattering_;
  }

  const WorldFacts& facts_;
  core::BlockCoord block_;
  const KeptModels* kept_;
  world::BlockObstacles obstacles_;
  std::optional<world::Scattering> scattering_;  // of this number
  std::uint32_t number_ = 0;
};

void place_on(const WorldFacts& facts, const visibility::NodeCoord& at, const NodeChange& change,
              std::vector<world::Placement>& scratch) {
  if (!change.placed) {
    if (change.kept == nullptr) return list_models(facts, at, scratch);
    world::place_models(facts.world, facts.registry, visibility::corner_block(at),
                        change.kept->wanted(), scratch);
  }
  if (auto water = water_placement(facts, at)) scratch.push_back(*water);
}

// Keeps the entities of models that stay, and their drawn meshes.
void update_models(const WorldFacts& facts, const visibility::NodeCoord& at,
                   const NodeChange& change, ecs::Entity node,
                   std::vector<world::Placement>& scratch, const NodeWork& work) {
  ecs::World& entities = work.entities;
  const core::BlockCoord block = visibility::corner_block(at);
  place_on(facts, at, change, scratch);
  const std::span<const ecs::Entity> now = entities.children(node);
  std::vector<ecs::Entity> before(now.begin(), now.end()), kept, gone;
  std::vector<world::Placement> created;
  StayingModels staying(facts, block, change.kept);
  // Both lists are sorted by index.
  std::size_t next = 0;
  for (const ecs::Entity model : before) {
    const MeshSource* source = entities.get<MeshSource>(model);
    if (source == nullptr) continue;
    if (staying.take(model, work.supply, entities)) {
      kept.push_back(model);
      continue;
    }
    while (next < scratch.size() && scratch[next].index < source->index)
      created.push_back(scratch[next++]);
    const bool stays = next < scratch.size() && scratch[next].index == source->index &&
                       scratch[next].model == source->model;
    if (stays)
      place_anew(facts, block, scratch[next++], change.world, model, work.supply, entities);
    (stays ? kept : gone).push_back(model);
  }
  created.insert(created.end(), scratch.begin() + static_cast<std::ptrdiff_t>(next), scratch.end());
  if (gone.empty() && created.empty()) return;
  destroy_models(gone, work.supply, entities, work.removed);
  const std::span<const ecs::Entity> added = create_meshes(facts, block, created, entities, true);
  tell_created(added, block, created, work.created);
  kept.insert(kept.end(), added.begin(), added.end());
  std::ranges::sort(kept, {},
                    [&](ecs::Entity model) { return entities.get<MeshSource>(model)->index; });
  entities.set_children(node, kept);
}

// Emits the models of nodes that are about to be destroyed.
void tell_removed(std::span<const ecs::Entity> nodes, const ecs::World& entities,
                  ecs::EventQueue<ModelRemoved>& removed) {
  if (!removed.has_readers()) return;
  std::vector<ModelRemoved> events;
  for (const ecs::Entity node : nodes) {
    if (entities.get<QuadtreeNode>(node)->at.level != 0) continue;
    entities.each_of<const MeshPlacement, const MeshSource>(
        entities.children(node), [&events](auto rows, auto placed, auto sources) {
          for (std::size_t i = 0; i < rows.size(); ++i) {
            if (sources[i].index == kWaterIndex) continue;
            events.push_back({rows[i], placed[i].block, sources[i].index, sources[i].model});
          }
        });
  }
  removed.emit(events);
}

}  // namespace

std::vector<bool> KeptModels::wanted() const {
  std::vector<bool> wanted;
  for (const Stays of : stays)
    wanted.push_back(of == Stays::kNothing);
  return wanted;
}

models::Parameters lit_ground(const WorldFacts& facts, const Daylight& daylight,
                              const visibility::NodeCoord& at) {
  models::Parameters ground = node_terrain(facts.world, at);
  world::set_sun(ground, daylight.azimuth_deg, daylight.elevation_deg);
  return ground;
}

ecs::Entity create_node(const SceneSettings& settings, const WorldFacts& facts,
                        const Daylight& daylight, const visibility::NodeCoord& at,
                        std::vector<world::Placement>& scratch, const NodeWork& work) {
  const NodeLevel& level = facts.levels[at.level];
  const auto created =
      work.entities.create<QuadtreeNode, ecs::Children, Visibility, MissingMeshes, GroundOccluder,
                           GroundSunlight, MeshPlacement, LodErrors, MeshSource, MeshDemand, Mesh>(
          1);
  const bool solid = settings.plp_mode == visibility::PlpMode::kSolidity;
  created.column<QuadtreeNode>()[0] = {
      at, level.bounds.min.y, level.bounds.max.y,
      solid ? node_solidity(facts.world, facts.standing, at) : 0.0F};
  fill(created, 0, ground_columns(facts, daylight, at));
  const ecs::Entity node = created.entities[0];
  create_models(facts, at, node, scratch, work.entities, work.created);
  return node;
}

std::vector<ecs::Entity> nodes_of(const ecs::World& entities) {
  std::vector<ecs::Entity> nodes;
  entities.each<const QuadtreeNode>(
      [&](auto rows, auto) { nodes.insert(nodes.end(), rows.begin(), rows.end()); });
  return nodes;
}

void destroy_nodes(std::span<const ecs::Entity> nodes, const NodeWork& work) {
  ecs::World& entities = work.entities;
  const auto release = [&](auto, auto demands, auto drawn) {
    for (std::size_t i = 0; i < demands.size(); ++i) {
      if (demands[i].drawn_level == kNoLevel) continue;
      work.supply.rank(drawn[i].handle, synthesis::Rank::unwanted());
    }
  };
  entities.each_of<const MeshDemand, const Mesh>(nodes, release);
  for (const ecs::Entity node : nodes)
    entities.each_of<const MeshDemand, const Mesh>(entities.children(node), release);
  tell_removed(nodes, entities, work.removed);
  entities.destroy_with_children(nodes);
}

void update_node(const WorldFacts& facts, const Daylight& daylight, ecs::Entity node,
                 const NodeChange& change, std::vector<world::Placement>& scratch,
                 const NodeWork& work) {
  ecs::World& entities = work.entities;
  const visibility::NodeCoord at = entities.get<QuadtreeNode>(node)->at;
  if (change.ground) {
    MeshDemand& demand = *entities.get<MeshDemand>(node);
    const bool shape = change.models || change.world || (demand.stale && !demand.stale_light);
    renew(lit_ground(facts, daylight, at), facts, node, work.supply, entities);
    demand.stale_light = demand.stale && !shape;
  } else {
    follow_layer(facts, entities.get<MeshSource>(node)->parameters);
  }
  if (change.world && change.ground) fit_ground(facts, daylight, node, entities);
  if (at.level == 0) {
    if (change.models) return update_models(facts, at, change, node, scratch, work);
    // Of the meshes of a block only its water, the last one, refers to the layer.
    if (const auto models = entities.children(node); !models.empty())
      follow_layer(facts, entities.get<MeshSource>(models.back())->parameters);
    return;
  }
  update_meshes(facts, at, change, node, scratch, work);
}

}  // namespace psygen::scene
