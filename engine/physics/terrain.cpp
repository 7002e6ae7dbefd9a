#include "engine/physics/terrain.hpp"

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/physics/convert.hpp"
#include "engine/physics/shapes.hpp"

namespace psygen::physics {
namespace {

constexpr double kFriction = 0.8;

// The difference of two indices, which wrap.
std::int64_t difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

std::int32_t sum(std::int32_t a, std::int64_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

}  // namespace

glm::dvec3 Terrain::corner_of(core::BlockCoord block) const {
  const double size = query_.world().block_size_m();
  return {static_cast<double>(difference(block.x, origin_.x)) * size, 0,
          static_cast<double>(difference(block.z, origin_.z)) * size};
}

core::WorldPosition Terrain::position(const btVector3& at) const {
  return core::normalised({origin_, to_glm(at)}, query_.world().block_size_m());
}

btVector3 Terrain::coordinates(const core::WorldPosition& at) const {
  return to_bt(corner_of(at.block) + at.local);
}

void Terrain::set_origin(core::BlockCoord origin) {
  clear();
  origin_ = origin;
}

btVector3 Terrain::inside(const btVector3& at, double margin_m) const {
  const world::World& world = query_.world();
  const double size = world.block_size_m();
  const auto limit = [&](double v, std::int32_t origin, std::int64_t blocks) {
    if (blocks == 0) return v;
    const double low = -static_cast<double>(origin) * size;
    const double high = static_cast<double>(blocks - origin) * size;
    const double margin = std::min(margin_m, 0.25 * static_cast<double>(blocks) * size);
    return std::clamp(v, low + margin, high - margin);
  };
  return {limit(at.x(), origin_.x, world.blocks_x), at.y(),
          limit(at.z(), origin_.z, world.blocks_z)};
}

models::GroundPoint Terrain::ground(const btVector3& at) {
  const core::WorldPosition p = position(inside(at, 1e-6));
  const glm::dvec2 local(p.local.x, p.local.z);
  if (const auto block = blocks_.find(p.block); block != blocks_.end())
    return block->second.grid->at(local);
  return query_.ground_grid(p.block).at(local);
}

void Terrain::add(Block& block, std::unique_ptr<btCollisionShape> shape, const btTransform& place,
                  Group group) {
  auto object = std::make_unique<btCollisionObject>();
  object->setCollisionShape(shape.get());
  object->setWorldTransform(place);
  object->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
  object->setFriction(kFriction);
  bullet_.addCollisionObject(object.get(), group, kBodies | kCharacters);
  block.shapes.push_back(std::move(shape));
  block.objects.push_back(std::move(object));
}

void Terrain::make(core::BlockCoord at, Block& block) {
  const glm::dvec3 corner = corner_of(at);
  const query::GroundGrid& grid = block.grid.emplace(query_.ground_grid(at));
  for (const std::uint16_t height : grid.heights())
    block.heights.push_back(grid.metres(height));
  auto ground = std::make_unique<btHeightfieldTerrainShape>(
      grid.size(), grid.size(), block.heights.data(), grid.lowest_m(), grid.highest_m(), 1, false);
  ground->setLocalScaling({grid.cell_m(), 1, grid.cell_m()});
  // Bullet's heightfields have their origin in the middle of their box.
  const double half = 0.5 * query_.world().block_size_m();
  const glm::dvec3 middle(half, 0.5 * (grid.lowest_m() + grid.highest_m()), half);
  add(block, std::move(ground), btTransform(btQuaternion::getIdentity(), to_bt(corner + middle)),
      kGround);
  for (const query::StandingSolid& s : query_.solids(at).solids) {
    for (const models::Collider::Shape& shape : s.solid.collider().shapes) {
      PlacedShape part = make_part(shape);
      part.place.setOrigin(part.place.getOrigin() + to_bt(corner + s.foot));
      add(block, std::move(part.shape), part.place, kModels);
    }
  }
}

void Terrain::need(const glm::dvec2& low, const glm::dvec2& high, std::uint64_t step) {
  const double size = query_.world().block_size_m(), reach = query_.models_reach_m();
  glm::dvec2 first = glm::floor((low - reach) / size), last = glm::floor((high + reach) / size);
  const glm::dvec2 middle = glm::floor((low + high) / (2 * size));
  first = glm::max(first, middle - double{kMostAside / 2});
  last = glm::min(last, middle + double{kMostAside / 2});
  for (double z = first.y; z <= last.y; ++z) {
    for (double x = first.x; x <= last.x; ++x) {
      const core::BlockCoord at{sum(origin_.x, static_cast<std::int64_t>(x)),
                                sum(origin_.z, static_cast<std::int64_t>(z))};
      if (!query_.world().contains(at)) continue;
      const auto [block, is_new] = blocks_.try_emplace(at);
      if (is_new) {
        make(at, block->second);
        block->second.edits = query::edits_of_block(query_.world(), at);
      }
      block->second.needed = step;
    }
  }
}

Terrain::Blocks::iterator Terrain::erase(Blocks::iterator block) {
  for (const auto& object : block->second.objects)
    bullet_.removeCollisionObject(object.get());
  return blocks_.erase(block);
}

void Terrain::remove(core::BlockCoord at) {
  if (const auto block = blocks_.find(at); block != blocks_.end()) erase(block);
}

bool Terrain::follow_edits() {
  if (query_.world().edits == edits_) return false;
  edits_ = query_.world().edits;
  const std::size_t before = blocks_.size();
  for (auto block = blocks_.begin(); block != blocks_.end();) {
    const bool changed = block->second.edits != query::edits_of_block(query_.world(), block->first);
    block = changed ? erase(block) : std::next(block);
  }
  return blocks_.size() != before;
}

void Terrain::clear() {
  while (!blocks_.empty())
    erase(blocks_.begin());
}

void Terrain::drop_idle(std::uint64_t step, std::uint32_t keep_steps, std::size_t most) {
  std::vector<std::tuple<std::uint64_t, core::BlockCoord>> idle;
  for (const auto& [at, block] : blocks_)
    if (block.needed < step) idle.emplace_back(block.needed, at);
  std::ranges::sort(idle);
  std::size_t left = idle.size();
  for (const auto& [needed, at] : idle) {
    if (left <= most && needed + keep_steps >= step) break;
    remove(at);
    --left;
  }
}

}  // namespace psygen::physics
