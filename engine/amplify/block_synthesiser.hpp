// Synthesises all meshes of a block, one after the other, in the same memory. The memory has a few
// hundred KiB and so stays in the processor's cache, where each mesh is also hashed. Keeps no mesh.
// One object per thread; no locks, and only the immutable world is shared.
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

// One finished mesh. Valid until the next one is made.
struct BlockMesh {
  const world::Placement& placement;  // for terrain: position 0, index world::kTerrainIndex
  int level;                          // level of detail
  models::MeshSize size;
  core::Bounds tight;  // tight bounds, as ModelType::synthesise() returned them
  models::MeshView view;
};

// Sums over blocks. Parts may be added in any order.
struct Totals {
  std::uint64_t blocks = 0, models = 0;  // models excludes terrain
  std::uint64_t triangles = 0;           // terrain counts without its skirts
  std::uint64_t bytes = 0;               // packed vertices and indices, without shared index lists
  std::uint64_t failed = 0;              // meshes of types that threw
  std::string first_failure;             // an error message; empty: none
  synthesis::WorldHash hash;
  // Adds the sums of other blocks. Keeps the first failure.
  void add(const Totals& part);
};

// Selects every level of detail instead of one.
inline constexpr int kAllLevels = -1;

// Synthesises blocks one by one.
class BlockSynthesiser {
 public:
  // `world` and `registry` must outlive it. `level` applies to all types (types with fewer levels
  // use their coarsest), or is kAllLevels.
  BlockSynthesiser(const world::World& world, const models::Registry& registry, int level = 0);

  // Synthesises `block` and adds it to `totals`. Calls `visit`, if given, for each mesh, terrain
  // first. A mesh that fails is counted and left out. Needs the stack of the types' synthesis.
  void synthesise(core::BlockCoord block, Totals& totals,
                  const std::function<void(const BlockMesh&)>& visit = {});

 private:
  // Hashing is a quarter faster if every load is from one cache line.
  struct alignas(64) CacheLine {
    std::byte bytes[64];
  };
  static std::size_t lines_of(std::size_t bytes) {
    return (bytes + sizeof(CacheLine) - 1) / sizeof(CacheLine);
  }

  // Makes the levels of one model. Returns false if one of them failed.
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

// The hash of the existing blocks among the 3 × 3 around `block`, at every level of detail. Nothing
// if a mesh failed.
std::optional<std::uint64_t> sample_world_hash(const world::World& world,
                                               const models::Registry& registry,
                                               core::BlockCoord block);

}  // namespace psygen::amplify
