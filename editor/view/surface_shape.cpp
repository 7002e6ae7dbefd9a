#include "editor/view/surface_shape.hpp"

#include "engine/models/edits.hpp"

namespace psygen::editor {
namespace {

// Cells at the border of a block belong to the block and to its neighbours.
constexpr double kMarginBlocks = 1.0 / 16;

}  // namespace

SurfaceShape::SurfaceShape(const world::World& world)
    : terrain_(world.terrain),
      water_(world.water),
      block_m_(world.block_size_m()),
      blocks_x_(world.blocks_x),
      blocks_z_(world.blocks_z),
      shape_(world::shape_hash(world)),
      layer_(world.layer()),
      edits_(world.edits) {
  terrain_.set_edits(nullptr, 0);
}

bool SurfaceShape::has_base_of(const SurfaceShape& other) const {
  return terrain_ == other.terrain_ && block_m_ == other.block_m_ &&
         water_.exists() == other.water_.exists() &&
         (!water_.exists() || water_.level_m == other.water_.level_m);
}

std::uint64_t SurfaceShape::shape_of(core::BlockCoord block) const {
  return layer_ ? layer_->ground.hash_of(models::QuadCoord::of(block), kMarginBlocks, block_m_) : 0;
}

bool SurfaceDifference::at(core::BlockCoord block) {
  if (!same_base_) return true;
  if (!last_ || last_->first != block)
    last_ = {block, before_.shape_of(block) != after_.shape_of(block)};
  return last_->second;
}

BareGround::BareGround(const world::World& of, std::size_t cache_bytes)
    : shape(of),
      world([&] {
        world::World bare = of;
        bare.scatter.clear();
        bare.places = {};
        return bare;
      }()),
      registry(models::make_standard_registry()),
      queries(world, registry, cache_bytes) {}

const std::shared_ptr<BareGround>& KeptGround::of(const world::World& world) {
  const bool is_new = std::exchange(world_is_new_, false);
  if (!ground_ || (is_new && !(ground_->shape == SurfaceShape(world))))
    ground_ = std::make_shared<BareGround>(world, cache_bytes_);
  return ground_;
}

}  // namespace psygen::editor
