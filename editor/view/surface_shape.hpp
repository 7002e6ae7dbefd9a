// The inputs of a world's surface: its ground and its water. Compares two worlds by block, so that
// known heights stay valid where the surface is unchanged. A shape is a value of some hundred bytes
// that keeps the edit layer of the ground alive; any thread.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "engine/models/registry.hpp"
#include "engine/query/world.hpp"
#include "engine/world/world.hpp"

namespace psygen::editor {

// Comparable inputs of a surface.
class SurfaceShape {
 public:
  explicit SurfaceShape(const world::World& world);

  // True only if the surfaces are equal everywhere and end at the same borders; false negatives are
  // possible.
  friend bool operator==(const SurfaceShape& a, const SurfaceShape& b) {
    return a.has_base_of(b) && a.blocks_x_ == b.blocks_x_ && a.blocks_z_ == b.blocks_z_ &&
           a.shape_ == b.shape_ && a.edits_ == b.edits_;
  }
  // True if the surfaces are equal except for stamps, roads, edits and borders.
  bool has_base_of(const SurfaceShape& other) const;
  // A hash of the stamps, roads and edits of a block; 0: none.
  std::uint64_t shape_of(core::BlockCoord block) const;

 private:
  models::Parameters terrain_;
  world::Water water_;
  double block_m_ = 0;
  std::int64_t blocks_x_ = 0, blocks_z_ = 0;
  std::uint64_t shape_ = 0;  // of the whole shaped ground
  std::shared_ptr<const models::EditLayer> layer_, edits_;
};

// Compares two surfaces block by block and caches the last answer.
class SurfaceDifference {
 public:
  SurfaceDifference(const SurfaceShape& before, const SurfaceShape& after)
      : before_(before), after_(after), same_base_(before.has_base_of(after)) {}
  // True if the surfaces differ in the block.
  bool at(core::BlockCoord block);

 private:
  const SurfaceShape &before_, &after_;
  bool same_base_;
  std::optional<std::pair<core::BlockCoord, bool>> last_;
};

// A copy of a world's ground and water with its own queries. It has no models and refers to nothing
// of the scene, so another thread may use it.
struct BareGround {
  // `cache_bytes`: of its queries.
  BareGround(const world::World& of, std::size_t cache_bytes);
  BareGround(const BareGround&) = delete;
  BareGround& operator=(const BareGround&) = delete;

  SurfaceShape shape;
  world::World world;
  models::Registry registry;
  query::World queries;
};

// Keeps a copy of the ground of the view's world, with its cached heights, while it is unchanged.
// Main thread only.
class KeptGround {
 public:
  explicit KeptGround(std::size_t cache_bytes) : cache_bytes_(cache_bytes) {}
  // To be called after a change of the world.
  void note_world() { world_is_new_ = true; }
  // The ground of the world; another copy if the surface has changed before the last note_world().
  const std::shared_ptr<BareGround>& of(const world::World& world);

 private:
  std::size_t cache_bytes_;
  std::shared_ptr<BareGround> ground_;
  bool world_is_new_ = false;
};

}  // namespace psygen::editor
