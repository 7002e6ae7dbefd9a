// Conversion of colliders into Bullet's shapes. Internal to physics. One thread.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/models/collider.hpp"

namespace psygen::physics {

// A shape with the parts that it points to.
struct OwnedShape {
  std::vector<std::unique_ptr<btCollisionShape>> parts;  // the last one is the whole
  double inner_m = 0;  // radius of a ball around the origin that the shape nearly fills
  btCollisionShape* get() const { return parts.back().get(); }
};

// Makes the shape of a collider around its origin. Fails with kInvalidArgument for a collider
// without parts, values that are not finite, and sizes outside kMinSizeM … kMaxSizeM.
core::Result<OwnedShape> make_shape(const models::Collider& collider);

// One part and its pose, unchecked.
struct PlacedShape {
  std::unique_ptr<btCollisionShape> shape;
  btTransform place;
};
PlacedShape make_part(const models::Collider::Shape& shape);

}  // namespace psygen::physics
