// Continuous collision detection: how far a body gets along its path in a step until a part of it
// meets another object. Sweeps the body's real shapes, which also turn. Knows nothing of the
// ground. Conservative advancement: B. Mirtich, "Impulse-based Dynamic Simulation of Rigid Body
// Systems", 1996, section 2.3. Internal to physics. One thread.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <functional>

namespace psygen::physics {

// A motion from one pose to another with constant velocity and spin.
struct Path {
  btTransform from = btTransform::getIdentity();
  btVector3 way{0, 0, 0}, turn{0, 0, 0};  // metres, radians

  static Path between(const btTransform& from, const btTransform& to);
  // Returns the pose at a share of the path, 0 … 1.
  btTransform at(double share) const;
};

// Returns the path of another object in the same step.
using PathOf = std::function<Path(const btCollisionObject&)>;

// The end of a path at an object.
struct Impact {
  double share = 1;         // of the path; 1: nothing stops it
  btVector3 push{0, 0, 0};  // displacement out of an overlap that was there before
};

// Returns where the body overlaps another object by a fraction of its own thickness, so that
// Bullet's next step finds their contact. Passes over slow parts, which Bullet's contacts stop, and
// over parts whose middle is inside an object. Linear in the objects near the path.
Impact first_impact(btDbvtBroadphase& broadphase, const btCollisionObject& body, const Path& path,
                    const PathOf& path_of);

}  // namespace psygen::physics
