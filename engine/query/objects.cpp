#include "engine/query/objects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "engine/query/world.hpp"

namespace psygen::query {
namespace {

using models::Collider;

// Returns the error of a part's size; empty if there is none.
std::string size_error(const Collider::Shape& shape) {
  if (const auto* capsule = std::get_if<Collider::Capsule>(&shape);
      capsule && !(2 * double{capsule->radius} >= Objects::kMinSizeM))
    return fmt::format("the radius {} m is below {} m", capsule->radius, Objects::kMinSizeM / 2);
  const core::Bounds box = models::bounds_of(shape);
  for (int i = 0; i < 3; ++i) {
    const double low = double{box.min[i]}, high = double{box.max[i]};
    if (!std::isfinite(low) || !std::isfinite(high)) return "a value is not finite";
    if (high - low < Objects::kMinSizeM)
      return fmt::format("it is {} m thick along {}, less than {} m", high - low, "xyz"[i],
                         Objects::kMinSizeM);
    if (std::max(std::abs(low), std::abs(high)) > Objects::kMaxSizeM)
      return fmt::format("it reaches farther than {} m from its origin", Objects::kMaxSizeM);
  }
  return {};
}

std::string part_error(const Collider::Shape& shape) {
  const auto* hull = std::get_if<Collider::Hull>(&shape);
  if (hull == nullptr) return size_error(shape);
  const std::size_t count = hull->points.size();
  if (count < 4 || count > Objects::kMaxHullPoints)
    return fmt::format("a hull has 4 … {} points, not {}", Objects::kMaxHullPoints, count);
  if (!std::ranges::all_of(hull->points, [](const glm::vec3& p) { return core::is_finite(p); }))
    return "a value is not finite";
  if (std::string error = size_error(shape); !error.empty()) return error;
  return hull_faces(hull->points).empty() ? "the points of the hull lie in one plane" : "";
}

Collider::Shape scaled_shape(const Collider::Shape& shape, const glm::vec3& scale) {
  const glm::vec3 size = glm::abs(scale);
  const float most = std::max({size.x, size.y, size.z});
  struct Visitor {
    const glm::vec3& scale;
    float most;
    Collider::Shape operator()(const Collider::Sphere& s) const {
      return Collider::Sphere{s.centre * scale, s.radius * most};
    }
    Collider::Shape operator()(const Collider::Capsule& c) const {
      return Collider::Capsule{c.from * scale, c.to * scale, c.radius * most};
    }
    Collider::Shape operator()(const Collider::Box& b) const {
      return Collider::Box{glm::min(b.min * scale, b.max * scale),
                           glm::max(b.min * scale, b.max * scale)};
    }
    Collider::Shape operator()(const Collider::Hull& h) const {
      Collider::Hull hull = h;
      for (glm::vec3& p : hull.points)
        p *= scale;
      return hull;
    }
  };
  return std::visit(Visitor{scale, most}, shape);
}

// Returns the collider of an object with this scale. Unscaled objects share one collider.
core::Result<ObjectShape> scaled_solid(const ObjectShape& shape, const glm::vec3& scale) {
  if (scale == glm::vec3(1.0F)) return shape;
  Collider collider;
  for (const Collider::Shape& part : shape->collider().shapes) {
    Collider::Shape scaled = scaled_shape(part, scale);
    if (const std::string error = size_error(scaled); !error.empty())
      return core::invalid_argument(
          fmt::format("scaled by ({}, {}, {}), part {} of the collider is unusable: {}", scale.x,
                      scale.y, scale.z, collider.shapes.size(), error));
    collider.shapes.push_back(std::move(scaled));
  }
  return std::make_shared<Solid>(std::move(collider));
}

}  // namespace

bool ObjectPose::operator==(const ObjectPose& other) const {
  return position.block == other.position.block && position.local == other.position.local &&
         rotation == other.rotation && scale == other.scale;
}

core::Result<ObjectShape> Objects::make_shape(Collider collider) {
  if (collider.empty() || collider.shapes.size() > kMaxParts)
    return core::invalid_argument(
        fmt::format("a collider has 1 … {} parts, not {}", kMaxParts, collider.shapes.size()));
  for (std::size_t i = 0; i < collider.shapes.size(); ++i) {
    if (const std::string error = part_error(collider.shapes[i]); !error.empty())
      return core::invalid_argument(
          fmt::format("part {} of the collider is unusable: {}", i, error));
  }
  return std::make_shared<Solid>(std::move(collider));
}

// Returns the checked pose, without a shape.
core::Result<PlacedObject> Objects::placed(const ObjectPose& pose) const {
  const auto at = checked(pose.position, world_->block_size_m());
  if (!at) return tl::unexpected(at.error());
  if (!world_->contains(at->block))
    return core::invalid_argument(
        fmt::format("block ({}, {}) is outside the world", at->block.x, at->block.z));
  const double length = glm::length(pose.rotation);
  if (!(length > 1e-6 && length < 1e6))
    return core::invalid_argument("the rotation is not a finite quaternion above zero");
  PlacedObject object;
  object.pose = pose;
  object.position = *at;
  object.rotation = pose.rotation / length;
  return object;
}

void Objects::follow_world() {
  if (world_ == nullptr || world_->block_size_m() == block_m_) return;
  const double before_m = std::exchange(block_m_, world_->block_size_m());
  origin_ = world::rebased({origin_}, before_m, block_m_).block;
  for (Slot& slot : slots_) {
    if (!slot.lives) continue;
    PlacedObject& object = slot.object;
    object.pose.position = world::rebased(object.pose.position, before_m, block_m_);
    object.position = world::rebased(object.position, before_m, block_m_);
    tree_.move(slot.leaf, box_of(object), glm::dvec3(0.0));
  }
}

glm::dvec3 Objects::coordinates(const core::WorldPosition& at) const {
  return core::offset_m(at.block, {origin_}, world_->block_size_m()) + at.local;
}

WideBox Objects::box_of(const PlacedObject& object) const {
  const core::Bounds& box = object.scaled->box();
  const glm::dmat3 turn = glm::mat3_cast(object.rotation);
  const glm::dvec3 half(box.half_extent());
  const glm::dvec3 reach =
      glm::abs(turn[0]) * half.x + glm::abs(turn[1]) * half.y + glm::abs(turn[2]) * half.z;
  const glm::dvec3 centre = coordinates(object.position) + turn * glm::dvec3(box.centre());
  return {centre - reach, centre + reach};
}

core::Result<ObjectId> Objects::add(ObjectTag name, const ObjectShape& shape,
                                    const ObjectPose& pose) {
  if (world_ == nullptr || shape == nullptr || name == 0)
    return core::invalid_argument("an object needs a world, a shape and a name above 0");
  follow_world();
  if (size() >= kMaxObjects)
    return core::fail(core::ErrorCode::kOverBudget,
                      fmt::format("there are {} objects already", kMaxObjects));
  auto object = placed(pose);
  if (!object) return tl::unexpected(object.error());
  auto scaled = scaled_solid(shape, pose.scale);
  if (!scaled) return tl::unexpected(scaled.error());
  object->name = name;
  object->shape = shape;
  object->scaled = std::move(*scaled);
  if (size() == 0) origin_ = object->position.block;
  std::uint32_t number = static_cast<std::uint32_t>(slots_.size());
  if (free_.empty()) {
    slots_.emplace_back();
  } else {
    number = free_.back();
    free_.pop_back();
  }
  Slot& slot = slots_[number];
  slot.object = std::move(*object);
  slot.leaf = tree_.insert(box_of(slot.object), number);
  slot.lives = slot.told = true;
  ++slot.generation;
  return ObjectId{number, slot.generation};
}

core::Result<void> Objects::move(ObjectId id, const ObjectPose& pose) {
  if (find(id) == nullptr) return core::invalid_argument("the object does not exist");
  follow_world();
  Slot& slot = slots_[id.slot];
  if (slot.object.pose == pose) {
    slot.told = true;
    return {};
  }
  auto object = placed(pose);
  if (!object) return tl::unexpected(object.error());
  object->name = slot.object.name;
  object->shape = slot.object.shape;
  object->scaled = slot.object.scaled;
  if (pose.scale != slot.object.pose.scale) {
    auto scaled = scaled_solid(object->shape, pose.scale);
    if (!scaled) return tl::unexpected(scaled.error());
    object->scaled = std::move(*scaled);
  }
  const glm::dvec3 way_m = coordinates(object->position) - coordinates(slot.object.position);
  slot.object = std::move(*object);
  // A long jump predicts no further jumps.
  const bool jumps = glm::dot(way_m, way_m) > 4;
  tree_.move(slot.leaf, box_of(slot.object), jumps ? glm::dvec3(0.0) : way_m);
  slot.told = true;
  return {};
}

bool Objects::remove(ObjectId id) {
  if (find(id) == nullptr) return false;
  Slot& slot = slots_[id.slot];
  tree_.remove(slot.leaf);
  slot.object = {};
  slot.lives = false;
  free_.push_back(id.slot);
  return true;
}

std::size_t Objects::remove_stale() {
  follow_world();
  std::size_t removed = 0;
  for (std::uint32_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i].lives && !std::exchange(slots_[i].told, false))
      removed += remove({i, slots_[i].generation}) ? 1 : 0;
  }
  return removed;
}

const PlacedObject* Objects::find(ObjectId id) const {
  if (id.slot >= slots_.size()) return nullptr;
  const Slot& slot = slots_[id.slot];
  return slot.lives && slot.generation == id.generation ? &slot.object : nullptr;
}

std::optional<ObjectHit> Objects::cast(const core::WorldPosition& origin,
                                       const glm::dvec3& direction, double longest_m) const {
  std::optional<ObjectHit> nearest;
  if (size() == 0) return nearest;
  const BoxLine line({coordinates(origin), direction});
  tree_.each_on(line, longest_m, [&](std::uint32_t number, double longest) {
    const PlacedObject& object = slots_[number].object;
    const glm::dvec3 from = origin.local - (core::offset_m(object.position.block, {origin.block},
                                                           world_->block_size_m()) +
                                            object.position.local);
    const glm::dquat back = glm::conjugate(object.rotation);
    const auto hit = object.scaled->cast({back * from, back * direction}, longest);
    if (!hit) return longest;
    if (nearest && hit->t == nearest->hit.t && nearest->name < object.name) return longest;
    nearest = {{number, slots_[number].generation}, object.name, *hit};
    nearest->hit.normal = glm::vec3(object.rotation * glm::dvec3(hit->normal));
    return hit->t;
  });
  return nearest;
}

void Objects::near(const core::WorldPosition& centre, const glm::dvec3& half_extent_m,
                   std::vector<ObjectId>& out) const {
  out.clear();
  if (size() == 0) return;
  const glm::dvec3 at = coordinates(centre);
  tree_.each_in({at - half_extent_m, at + half_extent_m}, [&](std::uint32_t number) {
    out.push_back({number, slots_[number].generation});
  });
  std::ranges::sort(out);
}

}  // namespace psygen::query
