#include "engine/query/block_cache.hpp"

#include <algorithm>
#include <limits>

#include "engine/core/hash.hpp"
#include "engine/core/rounding.hpp"
#include "engine/models/edits.hpp"
#include "engine/models/terrain/ground.hpp"
#include "engine/models/terrain/terrain.hpp"

namespace psygen::query {
namespace {

// Bytes of a block's list node and its entry in the index.
constexpr std::size_t kBlockBytes = 256;

void add(BlockSolids& all, StandingSolid solid) {
  const glm::vec3 foot(solid.foot);
  const core::Bounds box{solid.solid.box().min + foot, solid.solid.box().max + foot};
  all.box = all.boxes.empty() ? box : core::united(all.box, box);
  all.boxes.push_back(box);
  all.solids.push_back(std::move(solid));
}

}  // namespace

BlockCache::BlockCache(const world::World& world, const models::Registry& registry,
                       std::size_t max_bytes)
    : world_(world),
      registry_(registry),
      max_bytes_(max_bytes),
      edits_(world.edits),
      revision_(world.revision.number) {}

// Drops the blocks that edits have changed since the last call, or all of a replaced world.
void BlockCache::follow_world() {
  if (world_.revision.number != revision_) {
    revision_ = world_.revision.number;
    edits_ = world_.edits;
    blocks_.clear();
    index_.clear();
    bytes_ = 0;
  }
  if (world_.edits == edits_) return;
  edits_ = world_.edits;
  for (auto block = blocks_.begin(); block != blocks_.end();) {
    const core::BlockCoord at = block->at;
    const bool changed = block->edits != edits_of_block(world_, at);
    ++block;
    if (changed) forget(at);
  }
}

BlockCache::Block& BlockCache::touch(core::BlockCoord block) {
  follow_world();
  if (!blocks_.empty() && blocks_.front().at == block) return blocks_.front();
  if (const auto found = index_.find(block); found != index_.end()) {
    blocks_.splice(blocks_.begin(), blocks_, found->second);
    return blocks_.front();
  }
  blocks_.push_front({.at = block, .edits = edits_of_block(world_, block)});
  index_.emplace(block, blocks_.begin());
  charge(blocks_.front(), kBlockBytes);
  return blocks_.front();
}

// Charges bytes to the block, which is first in the order, and evicts blocks from the end.
void BlockCache::charge(Block& block, std::size_t bytes) {
  block.bytes += bytes;
  bytes_ += bytes;
  while (bytes_ > max_bytes_ && blocks_.size() > 1)
    forget(blocks_.back().at);
}

const GroundGrid& BlockCache::ground(core::BlockCoord at) {
  Block& block = touch(at);
  if (!block.ground) {
    const core::RoundToNearest rounding;
    block.ground.emplace(ground_of_block(world_, at), world_.cell_m(),
                         world_.terrain.real(models::kTerrainReliefM));
    charge(block, block.ground->bytes());
  }
  return *block.ground;
}

std::span<const world::Placement> BlockCache::models(core::BlockCoord at) {
  Block& block = touch(at);
  if (!block.models) {
    const core::RoundToNearest rounding;
    block.models = models_of_block(world_, registry_, at);
    charge(block, block.models->capacity() * sizeof(world::Placement));
  }
  return *block.models;
}

BlockSolids& BlockCache::solids(core::BlockCoord at) {
  const std::span<const world::Placement> models = this->models(at);
  Block& block = touch(at);
  if (!block.solids) {
    const core::RoundToNearest rounding;
    block.solids.emplace();
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < models.size(); ++i) {
      Solid solid(registry_[models[i].model].collider(models[i].parameters));
      if (solid.collider().empty()) continue;
      bytes += solid.heap_bytes();
      add(*block.solids, {i, glm::dvec3(models[i].position), std::move(solid)});
    }
    bytes += block.solids->solids.capacity() * sizeof(StandingSolid) +
             block.solids->boxes.capacity() * sizeof(core::Bounds);
    charge(block, bytes);
  }
  return *block.solids;
}

void BlockCache::forget(core::BlockCoord block) {
  const auto found = index_.find(block);
  if (found == index_.end()) return;
  bytes_ -= found->second->bytes;
  blocks_.erase(found->second);
  index_.erase(found);
}

std::vector<world::Placement> models_of_block(const world::World& world,
                                              const models::Registry& registry,
                                              core::BlockCoord block) {
  std::vector<world::Placement> models;
  models.reserve(world::models_per_block(world));
  world::place_models(world, registry, block, models);
  models.shrink_to_fit();
  return models;
}

std::uint64_t edits_of_block(const world::World& world, core::BlockCoord block) {
  if (!world.edits) return 0;
  const models::BlockEdits* const edits = world.edits->block(block);
  const std::uint64_t ground = world.edits->ground.edits.hash_of(
      models::QuadCoord::of(block), world::ground_margin(world, 0), world.block_size_m());
  if (ground == 0 && edits == nullptr) return 0;
  return core::combine(ground, edits != nullptr ? edits->hash() : 0);
}

}  // namespace psygen::query
