// The forces of water on bodies: buoyancy, drag, and drift with the current. Internal to physics.
// One thread.
#pragma once

#include <btBulletDynamicsCommon.h>

#include "engine/models/collider.hpp"
#include "engine/physics/terrain.hpp"
#include "engine/world/water.hpp"

namespace psygen::physics {

// The volume of a shape and the box around it, in the coordinates of its body. Overlaps of parts
// count twice.
struct Displacement {
  double volume_m3 = 0;
  glm::dvec3 centre{0.0}, half{0.0};  // of the box
};
Displacement displacement_of(const models::Collider& shape);

// Water at a place of Bullet's coordinates. Without water, `surface_m` is world::kDrySurfaceM.
struct WaterHere {
  double surface_m = world::kDrySurfaceM;
  btVector3 normal{0, 1, 0}, flow{0, 0, 0};
  // The height of the surface beside the place, by its slope.
  double surface_at(const btVector3& way) const {
    return surface_m - (normal.x() * way.x() + normal.z() * way.z()) / normal.y();
  }
};
WaterHere water_at(Terrain& terrain, const world::World& world, const btVector3& at);

// Changes the velocities of an active body for one step. `density` is that of the water in kg/m³.
// The water's inertia counts by half of what the body displaces, so light bodies stay calm.
void float_body(btRigidBody& rigid, const Displacement& shape, const WaterHere& water,
                double density, double gravity, double dt);

}  // namespace psygen::physics
