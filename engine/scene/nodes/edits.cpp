#include "engine/scene/nodes/edits.hpp"

#include <utility>

#include "engine/models/edits.hpp"
#include "engine/scene/components.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/world/placement.hpp"

namespace psygen::scene {
namespace {

using Blocks = models::QuadMap<models::BlockEdits>;

std::shared_ptr<const models::EditLayer> or_empty(std::shared_ptr<const models::EditLayer> layer) {
  return layer != nullptr ? std::move(layer) : std::make_shared<const models::EditLayer>();
}

std::uint64_t hash_in(const Blocks& blocks, const models::QuadCoord& at) {
  const Blocks::Cell* cell = blocks.at_or_below(at);
  return cell != nullptr ? cell->hash : 0;
}

}  // namespace

LayerChange::LayerChange(const world::World& world, std::shared_ptr<const models::EditLayer> before,
                         std::shared_ptr<const models::EditLayer> after)
    : world_(world), before_(or_empty(std::move(before))), after_(or_empty(std::move(after))) {}

NodeChange LayerChange::of(const visibility::NodeCoord& node) const {
  const auto at = models::QuadCoord::of(node.coord, node.level);
  const double margin = world::ground_margin(world_, node.level);
  const models::GroundStack &before = before_->ground, &after = after_->ground;
  const bool ground = !models::GroundStack::same_in(before, after, at, margin);
  // Light reaches further than heights.
  const double block_m = world_.block_size_m();
  const bool heights = ground && (before.reaches(at, block_m) || after.reaches(at, block_m));
  return {ground, heights || hash_in(before_->blocks, at) != hash_in(after_->blocks, at)};
}

void edits_system(const Daylight& daylight, PendingEdits& pending, WorldFacts& facts,
                  NodeWork work) {
  if (!std::exchange(pending.pending, false)) return;
  // Lives until no entity of the scene refers to it.
  const std::shared_ptr<const models::EditLayer> before = facts.world.layer();
  // Edits of a replaced world may have types and blocks that this one lacks.
  world::set_edits(
      facts.world,
      fitted(pending.edits, facts.world, facts.registry, facts.world.edits.get()).layer());
  work.supply.set_edits(facts.world.layer());
  count_placed(facts.world, facts.levels);
  facts.models_reach_m = world::with_placed_models(facts.scattered_reach_m, facts.world);
  const LayerChange change(facts.world, before, facts.world.layer());
  std::vector<world::Placement> scratch;
  for (const ecs::Entity node : nodes_of(work.entities)) {
    const visibility::NodeCoord at = work.entities.get<QuadtreeNode>(node)->at;
    update_node(facts, daylight, node, change.of(at), scratch, work);
  }
}

}  // namespace psygen::scene
