#include "engine/physics/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "engine/physics/ground_contacts.hpp"
#include "engine/physics/shapes.hpp"

namespace psygen::physics {
namespace {

constexpr double kFriction = 0.8;

}  // namespace

glm::dvec3 Terrain::corner_of(core::BlockCoord block) const {
  return core::offset_m(block, {origin_}, query_.world().block_size_m());
}

core::WorldPosition Terrain::position(const btVector3& at) const {
  return core::normalised({origin_, to_glm(at)}, query_.world().block_size_m());
}

btVector3 Terrain::coordinates(const core::WorldPosition& at) const {
  return to_bt(corner_of(at.block) + at.local);
}

void Terrain::set_origin(core::BlockCoord origin) {
  origin_ = origin;
  drop_idle(last_step_, 0, 0);
  for (auto& [at, block] : blocks_) {
    const btVector3 corner = to_bt(corner_of(at));
    for (const Part& part : block.parts) {
      btTransform pose = part.object->getWorldTransform();
      pose.setOrigin(corner + part.from_corner);
      put(bullet_, *part.object, pose);
    }
  }
}

bool Terrain::is_across_seam(core::BlockCoord block) const {
  const auto wraps = [](std::int32_t index, std::int32_t origin) {
    const std::int64_t away = std::int64_t{index} - origin;
    return away != static_cast<std::int32_t>(away);
  };
  return wraps(block.x, origin_.x) || wraps(block.z, origin_.z);
}

btVector3 Terrain::inside(const btVector3& at, double margin_m) const {
  const world::World& world = query_.world();
  const double size = world.block_size_m();
  const auto limit = [&](double v, std::int32_t origin, std::int64_t blocks) {
    const auto [first, end] = world::World::ends(blocks);
    const double low = static_cast<double>(first - origin) * size;
    const double high = static_cast<double>(end - origin) * size;
    const double margin = std::min(margin_m, 0.25 * static_cast<double>(end - first) * size);
    return std::clamp(v, low + margin, high - margin);
  };
  return {limit(at.x(), origin_.x, world.blocks_x), at.y(),
          limit(at.z(), origin_.z, world.blocks_z)};
}

models::GroundPoint Terrain::ground(const btVector3& at) {
  const core::WorldPosition p = position(inside(at, 1e-6));
  return query_.ground_grid(p.block).at({p.local.x, p.local.z});
}

void Terrain::add(core::BlockCoord at, Block& block, std::unique_ptr<btCollisionShape> shape,
                  const btTransform& place, Group group) {
  auto object = std::make_unique<btCollisionObject>();
  object->setCollisionShape(shape.get());
  object->setWorldTransform(
      btTransform(place.getBasis(), to_bt(corner_of(at)) + place.getOrigin()));
  object->setCollisionFlags(btCollisionObject::CF_STATIC_OBJECT);
  object->setFriction(kFriction);
  bullet_.addCollisionObject(object.get(), group, kBodies | kCharacters);
  block.parts.push_back({std::move(shape), std::move(object), place.getOrigin()});
}

double Terrain::height(core::BlockCoord at, int size, int x, int z) const {
  const int last = size - 1;
  const int aside_x = x < 0 ? -1 : x > last, aside_z = z < 0 ? -1 : z > last;
  const auto block = blocks_.find(core::moved(at, aside_x, aside_z));
  if (block == blocks_.end()) return std::numeric_limits<double>::quiet_NaN();
  return block->second
      .heights[static_cast<std::size_t>((z - aside_z * last) * size + x - aside_x * last)];
}

void Terrain::make(core::BlockCoord at, Block& block) {
  const query::GroundGrid& grid = query_.ground_grid(at);
  for (const std::uint16_t height : grid.heights())
    block.heights.push_back(grid.metres(height));
  auto ground = std::make_unique<GroundShape>(
      grid.size(), block.heights.data(), grid.cell_m(), grid.lowest_m(), grid.highest_m(),
      [this, at, size = grid.size()](int x, int z) { return height(at, size, x, z); });
  // Bullet's heightfields have their origin in the middle of their box.
  const double half = 0.5 * query_.world().block_size_m();
  const btVector3 middle(half, 0.5 * (grid.lowest_m() + grid.highest_m()), half);
  add(at, block, std::move(ground), upright(middle), kGround);
  for (const query::StandingSolid& s : query_.solids(at).solids) {
    for (const models::Collider::Shape& shape : s.solid.collider().shapes) {
      PlacedShape part = make_part(shape);
      part.place.setOrigin(part.place.getOrigin() + to_bt(s.foot));
      add(at, block, std::move(part.shape), part.place, kModels);
    }
  }
}

template <class Visit>
void Terrain::each_near(const glm::dvec2& low, const glm::dvec2& high, double reach_m,
                        const Visit& visit) const {
  const double size = query_.world().block_size_m();
  glm::dvec2 first = glm::floor((low - reach_m) / size), last = glm::floor((high + reach_m) / size);
  const glm::dvec2 middle = glm::floor((low + high) / (2 * size));
  first = glm::max(first, middle - double{kMaxAside / 2});
  last = glm::min(last, middle + double{kMaxAside / 2});
  for (double z = first.y; z <= last.y; ++z)
    for (double x = first.x; x <= last.x; ++x)
      if (!visit(core::moved(origin_, static_cast<std::int64_t>(x), static_cast<std::int64_t>(z))))
        return;
}

void Terrain::need(const glm::dvec2& low, const glm::dvec2& high, std::uint64_t step) {
  last_step_ = step;
  each_near(low, high, query_.models_reach_m(), [&](core::BlockCoord at) {
    if (!query_.world().contains(at)) return true;
    const auto [block, is_new] = blocks_.try_emplace(at);
    if (is_new) {
      make(at, block->second);
      block->second.edits = query::edits_of_block(query_.world(), at);
    }
    block->second.needed = step;
    return true;
  });
}

bool Terrain::is_near(const Changes& changes, const glm::dvec2& low, const glm::dvec2& high) const {
  bool near = false;
  each_near(low, high, changes.reach_m, [&](core::BlockCoord at) {
    near = changes.blocks.contains(at);
    return !near;
  });
  return near;
}

Terrain::Blocks::iterator Terrain::erase(Blocks::iterator block) {
  for (const Part& part : block->second.parts)
    bullet_.removeCollisionObject(part.object.get());
  return blocks_.erase(block);
}

void Terrain::remove(core::BlockCoord at) {
  if (const auto block = blocks_.find(at); block != blocks_.end()) erase(block);
}

std::optional<btVector3> Terrain::follow_world() {
  const world::World& world = query_.world();
  if (world.revision.number == revision_) return std::nullopt;
  revision_ = world.revision.number;
  clear();
  edits_ = world.edits;
  reach_m_ = query_.models_reach_m();
  const double before_m = std::exchange(block_m_, world.block_size_m());
  const core::WorldPosition corner = world::rebased({origin_}, before_m, block_m_);
  origin_ = corner.block;
  return to_bt(-corner.local);
}

Terrain::Changes Terrain::sync_edits() {
  Changes changes;
  if (query_.world().edits == edits_) return changes;
  edits_ = query_.world().edits;
  const double before_m = std::exchange(reach_m_, query_.models_reach_m());
  changes.reach_m = std::max(before_m, reach_m_);
  for (auto block = blocks_.begin(); block != blocks_.end();) {
    const core::BlockCoord at = block->first;
    if (block->second.edits == query::edits_of_block(query_.world(), at)) {
      ++block;
      continue;
    }
    changes.blocks.insert(at);
    block = erase(block);
  }
  return changes;
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
