// Takes over edits of the world: the ground and the models that they change get new parameters or
// other places, models come and go. What is drawn stays until the new mesh is there; that is
// synthesis like any other.
#include "engine/models/edits.hpp"

#include <algorithm>
#include <utility>

#include "engine/scene/nodes/entities.hpp"
#include "engine/scene/systems.hpp"
#include "engine/world/models_reach.hpp"

namespace psygen::scene {
namespace {

using Blocks = models::QuadMap<models::BlockEdits>;

// What differs between two layers, node by node.
class LayerChange {
 public:
  LayerChange(const world::World& world, const models::EditLayer* before,
              const models::EditLayer* after)
      : world_(world),
        before_(before != nullptr ? *before : none_),
        after_(after != nullptr ? *after : none_) {}

  NodeChange of(const visibility::NodeCoord& node) const {
    const auto at = models::QuadPlace::of(node.coord, node.level);
    const double margin = world::ground_margin(world_, node.level);
    const bool ground = !models::GroundEdits::same_in(before_.ground, after_.ground, at, margin);
    // Light reaches further than heights.
    const double block_m = world_.block_size_m();
    const bool heights =
        ground && (before_.ground.reaches(at, block_m) || after_.ground.reaches(at, block_m));
    return {ground, heights || hash_in(before_.blocks, at) != hash_in(after_.blocks, at)};
  }

 private:
  static std::uint64_t hash_in(const Blocks& blocks, const models::QuadPlace& at) {
    const Blocks::Cell* cell = blocks.at_or_below(at);
    return cell != nullptr ? cell->hash : 0;
  }

  const world::World& world_;
  const models::EditLayer none_;
  const models::EditLayer &before_, &after_;
};

// Places whose nodes changed need other meshes.
void note_stale(const LayerChange& change, Foresight& foresight) {
  const auto changed = [&change](const visibility::NodeCoord& node) {
    const NodeChange of = change.of(node);
    return of.ground || of.models;
  };
  for (Foresight::Place& place : foresight.places)
    place.stale = place.stale || std::ranges::any_of(place.nodes, changed);
}

}  // namespace

void edits_system(const Daylight& daylight, Editing& editing, WorldFacts& facts,
                  ecs::World& entities, synthesis::MeshSupply& meshes, Foresight& foresight,
                  ecs::EventQueue<ModelCreated>& created_models,
                  ecs::EventQueue<ModelRemoved>& removed_models) {
  if (!std::exchange(editing.pending, false)) return;
  // Kept until nothing in the scene refers to it.
  const std::shared_ptr<const models::EditLayer> before = facts.world.layer();
  world::set_edits(facts.world, editing.edits.layer());
  meshes.set_edits(facts.world.layer());
  facts.models_reach_m = world::with_placed_models(facts.scattered_reach_m, facts.world);
  const LayerChange change(facts.world, before.get(), facts.world.layer().get());
  std::vector<ecs::Entity> nodes;
  entities.each<const Node>([&](std::span<const ecs::Entity> rows, std::span<const Node>) {
    nodes.insert(nodes.end(), rows.begin(), rows.end());
  });
  note_stale(change, foresight);
  std::vector<world::Placement> scratch;
  for (const ecs::Entity node : nodes) {
    const visibility::NodeCoord at = entities.get<Node>(node)->at;
    update_node(facts, daylight, node, change.of(at), scratch, meshes, entities,
                {created_models, removed_models});
  }
}

}  // namespace psygen::scene
