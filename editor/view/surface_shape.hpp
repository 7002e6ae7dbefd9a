// What the surface of a world depends on: its ground and its water, and nothing else. Tells where
// two worlds have the same one, so that heights that are known need not be looked up again. A value
// of some hundred bytes that keeps the shape of the ground alive; any thread.
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "engine/world/world.hpp"

namespace psygen::editor {

class SurfaceShape {
 public:
  explicit SurfaceShape(const world::World& world);

  // The same everywhere. It may say no although it is.
  friend bool operator==(const SurfaceShape& a, const SurfaceShape& b) {
    return a.has_base_of(b) && a.shape_ == b.shape_ && a.edits_ == b.edits_;
  }
  // The same but for stamps, roads and edits.
  bool has_base_of(const SurfaceShape& other) const;
  // Of all that shapes the ground of a block by hand; 0: nothing does.
  std::uint64_t shape_of(core::BlockCoord block) const;

 private:
  models::Parameters terrain_;
  world::Water water_;
  double block_m_ = 0;
  std::uint64_t shape_ = 0;  // of the whole shaped ground
  std::shared_ptr<const models::EditLayer> layer_, edits_;
};

// Where two surfaces differ, asked block after block: the last answer is kept.
class SurfaceDifference {
 public:
  SurfaceDifference(const SurfaceShape& before, const SurfaceShape& after)
      : before_(before), after_(after), same_base_(before.has_base_of(after)) {}
  bool at(core::BlockCoord block);

 private:
  const SurfaceShape &before_, &after_;
  bool same_base_;
  std::optional<std::pair<core::BlockCoord, bool>> last_;
};

}  // namespace psygen::editor
