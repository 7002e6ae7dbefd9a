// Makes everything that stands on a block, one mesh after the other in memory that is used again
// for the next (a few hundred KiB, so that it stays in the processor's cache), and hashes it there.
// Nothing is kept. One object per thread; no locks, nothing shared but the immutable world.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/models/registry.hpp"
#include "engine/synthesis/content_hash.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/world.hpp"

namespace psygen::amplify {

// One finished mesh. The view is valid until the next one is made.
struct BlockMesh {
  const world::Placement& placement;  // of terrain: position 0, index world::kTerrainIndex
  int level;
  models::MeshSize size;
  core::Bounds tight;
  models::MeshView view;
};

// Sums over blocks; parts may be added in any order.
struct Totals {
  std::uint64_t blocks = 0, models = 0;  // the terrain is no model
  std::uint64_t triangles = 0;           // terrain without its skirts
  std::uint64_t bytes = 0;               // vertices and indices as packed; shared lists apart
  std::uint64_t failed = 0;              // meshes of types that threw
  std::string first_failure;
  synthesis::WorldHash hash;
  void add(const Totals& part);
};

// Instead of one level of detail.
inline constexpr int kAllLevels = -1;

class BlockSynthesizer {
 public:
  // World and registry outlive it. `level` is one for all types (the coarsest of those that have
  // fewer) or kAllLevels.
  BlockSynthesizer(const world::World& world, const models::Registry& registry, int level = 0);

  // Adds what stands on `block` to `totals`. `visit`, if given, sees each mesh, terrain first.
  void synthesise(core::BlockCoord block, Totals& totals,
                  const std::function<void(const BlockMesh&)>& visit = {});

 private:
  // Hashing is a quarter faster where every load is one line of the cache.
  struct alignas(64) CacheLine {
    std::byte bytes[64];
  };
  static std::size_t lines_of(std::size_t bytes) {
    return (bytes + sizeof(CacheLine) - 1) / sizeof(CacheLine);
  }

  // False where a level failed.
  bool make_levels(const world::Placement& placement, core::BlockCoord block, Totals& totals,
                   const std::function<void(const BlockMesh&)>& visit);
  void make(const world::Placement& placement, core::BlockCoord block, int level, Totals& totals,
            const std::function<void(const BlockMesh&)>& visit);
  models::MeshView room_for(const models::MeshSize& size);

  const world::World& world_;
  const models::Registry& registry_;
  int level_;
  std::vector<world::Placement> placements_;
  std::unique_ptr<CacheLine[]> memory_;
  std::size_t line_count_ = 0;
};

// The hash of the 3 × 3 blocks around `block`, as far as they exist, at every level. Nothing where
// a mesh failed.
std::optional<std::uint64_t> sample_world_hash(const world::World& world,
                                               const models::Registry& registry,
                                               core::BlockCoord block);

}  // namespace psygen::amplify
