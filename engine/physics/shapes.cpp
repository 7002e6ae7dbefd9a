#include "engine/physics/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/physics/types.hpp"

namespace psygen::physics {
namespace {

using models::Collider;

PlacedShape make(const Collider::Sphere& s) {
  return {std::make_unique<btSphereShape>(s.radius), upright(to_bt(s.centre))};
}

// Bullet's capsules are upright.
PlacedShape make(const Collider::Capsule& c) {
  const btVector3 from = to_bt(c.from), axis = to_bt(c.to) - from;
  const btScalar length = axis.length();
  const btQuaternion turn =
      length > 0 ? shortestArcQuat(btVector3(0, 1, 0), axis / length) : btQuaternion::getIdentity();
  return {std::make_unique<btCapsuleShape>(c.radius, length), btTransform(turn, from + axis / 2)};
}

PlacedShape make(const Collider::Box& b) {
  return {std::make_unique<btBoxShape>(to_bt(b.half_extent())), upright(to_bt(b.centre()))};
}

PlacedShape make(const Collider::Hull& h) {
  auto hull = std::make_unique<btConvexHullShape>();
  for (const glm::vec3& p : h.points)
    hull->addPoint(to_bt(p), false);
  hull->recalcLocalAabb();
  return {std::move(hull), upright({0, 0, 0})};
}

bool is_legal(const Collider::Shape& shape) {
  if (const auto* hull = std::get_if<Collider::Hull>(&shape); hull && hull->points.size() < 4)
    return false;
  if (const auto* capsule = std::get_if<Collider::Capsule>(&shape);
      capsule && !(capsule->radius * 2 >= kMinSizeM))
    return false;
  const core::Bounds box = models::bounds_of(shape);
  for (int i = 0; i < 3; ++i) {
    const double size = static_cast<double>(box.max[i]) - static_cast<double>(box.min[i]);
    const double far = std::max(std::abs(box.min[i]), std::abs(box.max[i]));
    if (!(size >= kMinSizeM && far <= kMaxSizeM)) return false;  // rejects NaN too
  }
  if (const auto* hull = std::get_if<Collider::Hull>(&shape))
    return std::ranges::all_of(hull->points, [](const glm::vec3& p) { return core::is_finite(p); });
  return true;
}

double inner_m(const Collider::Shape& shape) {
  if (const auto* capsule = std::get_if<Collider::Capsule>(&shape)) return capsule->radius;
  const glm::vec3 half = models::bounds_of(shape).half_extent();
  return std::min({half.x, half.y, half.z});
}

btVector3 middle_of(const Collider::Shape& shape) {
  const auto* hull = std::get_if<Collider::Hull>(&shape);
  if (hull == nullptr) return to_bt(models::bounds_of(shape).centre());
  glm::dvec3 sum(0);
  for (const glm::vec3& point : hull->points)
    sum += point;
  return to_bt(sum / static_cast<double>(hull->points.size()));
}

}  // namespace

PlacedShape make_part(const Collider::Shape& shape) {
  return std::visit([](const auto& s) { return make(s); }, shape);
}

core::Result<OwnedShape> make_shape(const models::Collider& collider) {
  if (collider.empty() || !std::ranges::all_of(collider.shapes, is_legal))
    return core::invalid_argument(
        fmt::format("the shape of a body needs parts of {} to {} m, with finite "
                    "values and at least four points for a hull",
                    kMinSizeM, kMaxSizeM));
  OwnedShape owned;
  auto whole = std::make_unique<btCompoundShape>();
  double inner = 0;
  for (const Collider::Shape& shape : collider.shapes) {
    PlacedShape part = make_part(shape);
    inner = std::max(inner, inner_m(shape));
    if (const btVector3 middle = middle_of(shape); middle.length2() > 0)
      owned.middles.push_back(middle);
    whole->addChildShape(part.place, part.shape.get());
    owned.parts.push_back(std::move(part.shape));
  }
  owned.inner_m = inner;
  // A single part around the origin needs no compound.
  if (owned.parts.size() == 1 && whole->getChildTransform(0) == btTransform::getIdentity())
    return owned;
  owned.parts.push_back(std::move(whole));
  return owned;
}

}  // namespace psygen::physics
