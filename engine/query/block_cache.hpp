// The blocks that queries asked for last: ground, models and colliders, each made when first needed
// and kept under a byte bound, least recently used out first. Not the cache of meshes. One thread.
#pragma once

#include <cstddef>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "engine/query/block_source.hpp"
#include "engine/query/ground_grid.hpp"
#include "engine/query/solid.hpp"

namespace psygen::query {

// A model with a collider.
struct StandingSolid {
  std::size_t model;     // position in BlockCache::models()
  glm::dvec3 foot{0.0};  // metres from the block's corner
  Solid solid;
};

// The models of a block that have colliders.
struct BlockSolids {
  std::vector<StandingSolid> solids;
  std::vector<core::Bounds> boxes;  // of each, in metres from the block's corner
  core::Bounds box;                 // around all of them; of no meaning without any
};

// World and registry must outlive it and must not change, except for the world's edits, between two
// calls: what they changed is made anew. Spans and references that it returns are valid until the
// next call.
class BlockCache {
 public:
  // Empty. Both outlive it; `max_bytes` is the bound of what it keeps.
  BlockCache(const world::World& world, const models::Registry& registry, std::size_t max_bytes);
  BlockCache(BlockCache&&) = default;
  BlockCache(const BlockCache&) = delete;

  // The parts of a block, which exists whether or not the world contains it. Constant time for the
  // blocks that are kept.
  const GroundGrid& ground(core::BlockCoord block);
  std::span<const world::Placement> models(core::BlockCoord block);
  BlockSolids& solids(core::BlockCoord block);

  // Held now. Above the bound only if a single block is.
  std::size_t bytes() const { return bytes_; }
  std::size_t size() const { return blocks_.size(); }

 private:
  struct Block {
    core::BlockCoord at;
    std::size_t bytes = 0;
    std::uint64_t edits = 0;  // edits_of_block() when it was made
    std::optional<GroundGrid> ground{};
    std::optional<std::vector<world::Placement>> models{};
    std::optional<BlockSolids> solids{};
  };
  using Order = std::list<Block>;  // most recently used first

  Block& touch(core::BlockCoord block);
  void forget(core::BlockCoord block);
  void follow_edits();
  void charge(Block& block, std::size_t bytes);

  const world::World& world_;
  const models::Registry& registry_;
  std::size_t max_bytes_, bytes_ = 0;
  std::shared_ptr<const models::EditLayer> edits_;  // of the world when they were last looked at
  Order blocks_;
  std::unordered_map<core::BlockCoord, Order::iterator, core::BlockCoordHash> index_;
};

}  // namespace psygen::query
