#include "engine/scene/nodes/entities.hpp"

#include <algorithm>
#include <optional>

#include "engine/scene/nodes/columns.hpp"
#include "engine/scene/nodes/levels.hpp"
#include "engine/scene/nodes/mesh_entity.hpp"
#include "engine/scene/nodes/solidity.hpp"
#include "engine/world/far/merged_models.hpp"

namespace psygen::scene {
namespace {

template <class Created>
void fill(const Created& created, std::size_t i, const MeshColumns& columns) {
  created.template column<Placed>()[i] = columns.placed;
  created.template column<Detail>()[i] = columns.detail;
  created.template column<Source>()[i] = columns.source;
}

// Creates mesh entities with the components of all such and `Also`.
template <class... Also>
std::span<const ecs::Entity> create_meshes(const WorldFacts& facts, core::BlockCoord block,
                                           std::span<const world::Placement> placements,
                                           ecs::World& entities, bool added = false) {
  const auto models =
      entities.create<Placed, Detail, Source, Demand, Mesh, Fading, Also...>(placements.size());
  for (std::size_t i = 0; i < placements.size(); ++i) {
    fill(models, i, columns_of(facts, block, placements[i]));
    models.template column<Demand>()[i].added = added;
  }
  return models.entities;
}

void tell_created(std::span<const ecs::Entity> models, core::BlockCoord block,
                  std::span<const world::Placement> placements,
                  ecs::EventQueue<ModelCreated>& created) {
  if (!created.has_readers()) return;
  std::vector<ModelCreated> events;
  for (std::size_t i = 0; i < models.size(); ++i)
    events.push_back({models[i], block, placements[i].index, placements[i].model});
  created.emit(events);
}

// The models of a block, or the one mesh of all models on a coarser node.
void create_models(const WorldFacts& facts, const visibility::NodeCoord& at, ecs::Entity node,
                   std::vector<world::Placement>& scratch, ecs::World& entities,
                   ecs::EventQueue<ModelCreated>& created) {
  const core::BlockCoord block = visibility::corner_block(at);
  if (at.level == 0) {
    world::place_models(facts.world, facts.registry, block, scratch);
    const std::span<const ecs::Entity> models = create_meshes(facts, block, scratch, entities);
    entities.set_children(node, models);
    tell_created(models, block, scratch, created);
  } else if (facts.levels[at.level].merged) {
    scratch.assign(1, merged_placement(facts, at));
    entities.set_children(node,
                          create_meshes<MeshParts, OldParts>(facts, block, scratch, entities));
  }
}

models::Parameters lit_ground(const WorldFacts& facts, const Daylight& daylight,
                              const visibility::NodeCoord& at) {
  models::Parameters ground = node_terrain(facts.world, at);
  world::set_sun(ground, daylight.azimuth_deg, daylight.elevation_deg);
  return ground;
}

MeshColumns ground_columns(const WorldFacts& facts, const Daylight& daylight,
                           const visibility::NodeCoord& at) {
  const int level = facts.levels[at.level].mesh_level;
  return columns_of(
      facts, visibility::corner_block(at),
      {facts.world.terrain_model, kTerrainIndex, glm::vec3(0.0F), lit_ground(facts, daylight, at)},
      at.level == 0 ? 0 : level, level);
}

// Whether what is drawn of an entity is of its present parameters and pictures. When an edit is
// taken back, the old mesh may still be drawn.
void note_stale(ecs::Entity entity, const synthesis::MeshSupply& meshes, ecs::World& entities) {
  Demand& demand = *entities.get<Demand>(entity);
  const synthesis::MeshRecord* drawn = meshes.ready(entities.get<Mesh>(entity)->handle);
  const Source& source = *entities.get<Source>(entity);
  const bool right = drawn != nullptr &&
                     drawn->key.model == (demand.pictured ? source.picture_model : source.model) &&
                     drawn->key.parameters_hash == hash_of(source, demand.pictured);
  demand.stale = demand.drawn_level != kNoLevel && !right;
}

// Sets what an entity shows from now on. True if that is another mesh.
bool renew(const models::Parameters& parameters, const WorldFacts& facts, ecs::Entity entity,
           const synthesis::MeshSupply& meshes, ecs::World& entities) {
  Source& source = *entities.get<Source>(entity);
  const std::uint64_t hash = models::parameters_hash(facts.registry[source.model], parameters);
  const bool other = source.parameters_hash != hash || source.parameters != parameters;
  source.parameters = parameters;  // the layer of edits is another one in any case
  if (!other) return false;
  source.parameters_hash = hash;
  Demand& demand = *entities.get<Demand>(entity);
  note_stale(entity, meshes, entities);
  demand.requested_level = kNoLevel;
  demand.failed_levels = 0;
  return true;
}

void place_anew(const WorldFacts& facts, core::BlockCoord block, const world::Placement& placement,
                bool world, ecs::Entity entity, const synthesis::MeshSupply& meshes,
                ecs::World& entities) {
  // The type of the meshes for all models of a node comes after the species, so it moves with them.
  entities.get<Source>(entity)->model = placement.model;
  if (!renew(placement.parameters, facts, entity, meshes, entities) && !world) {
    entities.get<Placed>(entity)->position = placement.position;
    return;
  }
  const MeshColumns columns = columns_of(facts, block, placement);
  *entities.get<Placed>(entity) = columns.placed;
  *entities.get<Detail>(entity) = columns.detail;
  entities.get<Source>(entity)->picture_model = columns.source.picture_model;
  entities.get<Source>(entity)->picture_set = columns.source.picture_set;
  if (!world) return;
  entities.get<Demand>(entity)->requested_level = kNoLevel;  // dropped meanwhile
  note_stale(entity, meshes, entities);
}

void destroy_models(std::span<const ecs::Entity> models, synthesis::MeshSupply& meshes,
                    ecs::World& entities, ecs::EventQueue<ModelRemoved>& removed) {
  std::vector<ModelRemoved> events;
  for (const ecs::Entity model : models) {
    if (entities.get<Demand>(model)->drawn_level != kNoLevel)
      meshes.rank(entities.get<Mesh>(model)->handle, synthesis::Rank::unwanted());
    const Source& source = *entities.get<Source>(model);
    events.push_back({model, entities.get<Placed>(model)->block, source.index, source.model});
  }
  if (removed.has_readers()) removed.emit(events);
  entities.destroy(models);
}

// The boxes and levels of a node's ground in a world that was replaced.
void fit_ground(const WorldFacts& facts, const Daylight& daylight, ecs::Entity node,
                ecs::World& entities) {
  const MeshColumns columns = ground_columns(facts, daylight, entities.get<Node>(node)->at);
  *entities.get<Placed>(node) = columns.placed;
  *entities.get<Detail>(node) = columns.detail;
  entities.get<Demand>(node)->requested_level = kNoLevel;
}

// Gives the instances of a block that stay what they are in the world that replaces another one.
class StayingModels {
 public:
  // `kept` may be null: nothing stays.
  StayingModels(const WorldFacts& facts, core::BlockCoord block, const KeptModels* kept)
      : facts_(facts), block_(block), kept_(kept) {}

  // False for one that is placed anew.
  bool take(ecs::Entity model, const synthesis::MeshSupply& meshes, ecs::World& entities) {
    const Source& source = *entities.get<Source>(model);
    if (kept_ == nullptr || source.index >= kept_->scatter_of.size()) return false;
    const std::uint32_t scatter = kept_->scatter_of[source.index];
    const KeptModels::Stays stays = kept_->stays[scatter];
    if (stays == KeptModels::Stays::kNothing) return false;
    world::Placement placed{source.model, source.index, entities.get<Placed>(model)->position,
                            source.parameters};
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
      scattering_.emplace(facts_.world, facts_.registry[scatter.model], scatter, block_);
      number_ = number;
    }
    return *scattering_;
  }

  const WorldFacts& facts_;
  core::BlockCoord block_;
  const KeptModels* kept_;
  std::optional<world::Scattering> scattering_;  // of this number
  std::uint32_t number_ = 0;
};

void place_on(const WorldFacts& facts, core::BlockCoord block, const NodeChange& change,
              std::vector<world::Placement>& scratch) {
  if (change.placed) return;
  if (change.kept == nullptr)
    return world::place_models(facts.world, facts.registry, block, scratch);
  world::place_models(facts.world, facts.registry, block, change.kept->wanted(), scratch);
}

// Entities of models that stay are kept, with what is drawn of them.
void update_models(const WorldFacts& facts, core::BlockCoord block, const NodeChange& change,
                   ecs::Entity node, std::vector<world::Placement>& scratch,
                   synthesis::MeshSupply& meshes, ecs::World& entities, const ModelEvents& events) {
  place_on(facts, block, change, scratch);
  const std::span<const ecs::Entity> now = entities.children(node);
  std::vector<ecs::Entity> before(now.begin(), now.end()), kept, gone;
  std::vector<world::Placement> created;
  StayingModels staying(facts, block, change.kept);
  // Both are sorted by index.
  std::size_t next = 0;
  for (const ecs::Entity model : before) {
    const Source* source = entities.get<Source>(model);
    if (source == nullptr) continue;
    if (staying.take(model, meshes, entities)) {
      kept.push_back(model);
      continue;
    }
    while (next < scratch.size() && scratch[next].index < source->index)
      created.push_back(scratch[next++]);
    const bool stays = next < scratch.size() && scratch[next].index == source->index &&
                       scratch[next].model == source->model;
    if (stays) place_anew(facts, block, scratch[next++], change.world, model, meshes, entities);
    (stays ? kept : gone).push_back(model);
  }
  created.insert(created.end(), scratch.begin() + static_cast<std::ptrdiff_t>(next), scratch.end());
  if (gone.empty() && created.empty()) return;
  destroy_models(gone, meshes, entities, events.removed);
  const std::span<const ecs::Entity> added = create_meshes(facts, block, created, entities, true);
  tell_created(added, block, created, events.created);
  kept.insert(kept.end(), added.begin(), added.end());
  std::ranges::sort(kept, {},
                    [&](ecs::Entity model) { return entities.get<Source>(model)->index; });
  entities.set_children(node, kept);
}

// `nodes` are about to be destroyed, and the models on them.
void tell_removed(std::span<const ecs::Entity> nodes, const ecs::World& entities,
                  ecs::EventQueue<ModelRemoved>& removed) {
  if (!removed.has_readers()) return;
  std::vector<ModelRemoved> events;
  for (const ecs::Entity node : nodes) {
    if (entities.get<Node>(node)->at.level != 0) continue;
    entities.each_of<const Placed, const Source>(
        entities.children(node),
        [&events](std::span<const ecs::Entity> rows, std::span<const Placed> placed,
                  std::span<const Source> sources) {
          for (std::size_t i = 0; i < rows.size(); ++i)
            events.push_back({rows[i], placed[i].block, sources[i].index, sources[i].model});
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

ecs::Entity create_node(const Settings& settings, const WorldFacts& facts, const Daylight& daylight,
                        const visibility::NodeCoord& at, std::vector<world::Placement>& scratch,
                        ecs::World& entities, ecs::EventQueue<ModelCreated>& created_models) {
  const NodeLevel& level = facts.levels[at.level];
  const auto created = entities.create<Node, ecs::Children, Visibility, Lacking, GroundRelief,
                                       GroundSun, Placed, Detail, Source, Demand, Mesh>(1);
  const bool solid = settings.plp_mode == visibility::PlpMode::kSolidity;
  created.column<Node>()[0] = {at, level.bounds.min.y, level.bounds.max.y,
                               solid ? node_solidity(facts.world, facts.standing, at) : 0.0F};
  fill(created, 0, ground_columns(facts, daylight, at));
  const ecs::Entity node = created.entities[0];
  create_models(facts, at, node, scratch, entities, created_models);
  return node;
}

void destroy_nodes(std::span<const ecs::Entity> nodes, synthesis::MeshSupply& meshes,
                   ecs::World& entities, ecs::EventQueue<ModelRemoved>& removed) {
  const auto give_back = [&](std::span<const ecs::Entity>, std::span<const Demand> demands,
                             std::span<const Mesh> drawn) {
    for (std::size_t i = 0; i < demands.size(); ++i) {
      if (demands[i].drawn_level == kNoLevel) continue;
      meshes.rank(drawn[i].handle, synthesis::Rank::unwanted());
    }
  };
  entities.each_of<const Demand, const Mesh>(nodes, give_back);
  for (const ecs::Entity node : nodes)
    entities.each_of<const Demand, const Mesh>(entities.children(node), give_back);
  tell_removed(nodes, entities, removed);
  entities.destroy_with_children(nodes);
}

void update_node(const WorldFacts& facts, const Daylight& daylight, ecs::Entity node,
                 const NodeChange& change, std::vector<world::Placement>& scratch,
                 synthesis::MeshSupply& meshes, ecs::World& entities, const ModelEvents& events) {
  const visibility::NodeCoord at = entities.get<Node>(node)->at;
  if (change.ground) {
    renew(lit_ground(facts, daylight, at), facts, node, meshes, entities);
  } else if (models::Parameters& p = entities.get<Source>(node)->parameters; p.edits() != nullptr) {
    p.set_edits(facts.world.layer().get(), p.edits_hash());
  }
  if (change.world && change.ground) fit_ground(facts, daylight, node, entities);
  const core::BlockCoord block = visibility::corner_block(at);
  if (at.level == 0) {
    if (change.models) update_models(facts, block, change, node, scratch, meshes, entities, events);
    return;
  }
  for (const ecs::Entity model : entities.children(node)) {
    models::Parameters& p = entities.get<Source>(model)->parameters;
    if (change.ground || change.models) {
      place_anew(facts, block, merged_placement(facts, at), change.world, model, meshes, entities);
    } else if (p.edits() != nullptr) {
      p.set_edits(facts.world.layer().get(), p.edits_hash());
    }
  }
}

}  // namespace psygen::scene
