// Caches the blocks that queries used last: ground, models and colliders, each made on first use
// and kept within a byte bound. Evicts the least recently used block first. Not the geometry cache.
// One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "engine/models/registry.hpp"
#include "engine/query/ground_grid.hpp"
#include "engine/query/solid.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/world.hpp"

namespace psygen::query {

// A model with a collider.
struct StandingSolid {
  std::size_t model;     // index into BlockCache::models()
  glm::dvec3 foot{0.0};  // metres from the block's corner
  Solid solid;
};

// The models with colliders of a block.
struct BlockSolids {
  std::vector<StandingSolid> solids;
  std::vector<core::Bounds> boxes;  // of each solid, in metres from the block's corner
  core::Bounds box;                 // around all solids; meaningless without solids
};

// World and registry must outlive the cache. Between two calls the world's edits may change: the
// cache then rebuilds the blocks that they reach. After a new World::revision it drops all blocks.
// Returned spans and references are valid until the next call.
class BlockCache {
 public:
  // An empty cache. `max_bytes` bounds the memory of the cached blocks.
  BlockCache(const world::World& world, const models::Registry& registry, std::size_t max_bytes);
  BlockCache(BlockCache&&) = default;
  BlockCache(const BlockCache&) = delete;

  // The parts of a block, inside or outside the world. Constant time for cached blocks.
  const GroundGrid& ground(core::BlockCoord block);
  std::span<const world::Placement> models(core::BlockCoord block);
  BlockSolids& solids(core::BlockCoord block);

  // Bytes and number of the cached blocks. The bytes exceed the bound only if a single block does.
  std::size_t bytes() const { return bytes_; }
  std::size_t size() const { return blocks_.size(); }

 private:
  struct Block {
    core::BlockCoord at;
    std::size_t bytes = 0;
    std::uint64_t edits = 0;  // edits_of_block() at the time of construction
    std::optional<GroundGrid> ground{};
    std::optional<std::vector<world::Placement>> models{};
    std::optional<BlockSolids> solids{};
  };
  using Order = std::list<Block>;  // most recently used first

  Block& touch(core::BlockCoord block);
  void forget(core::BlockCoord block);
  void follow_world();
  void charge(Block& block, std::size_t bytes);

  const world::World& world_;
  const models::Registry& registry_;
  std::size_t max_bytes_, bytes_ = 0;
  std::shared_ptr<const models::EditLayer> edits_;  // the world's edits at the last call
  std::uint64_t revision_;                          // and its revision
  Order blocks_;
  std::unordered_map<core::BlockCoord, Order::iterator, core::BlockCoordHash> index_;
};

// The source of models, for queries and physics, which use no other one. Pure; any thread.

// Returns the models of a block by growing index. Takes as long as world::ground_of_block(), plus
// 0.1 µs for each model.
std::vector<world::Placement> models_of_block(const world::World& world,
                                              const models::Registry& registry,
                                              core::BlockCoord block);

// Returns a hash of the edits that change a block; 0 if none do. Equal hashes: equal ground and
// models. Logarithmic in the edits.
std::uint64_t edits_of_block(const world::World& world, core::BlockCoord block);

}  // namespace psygen::query
