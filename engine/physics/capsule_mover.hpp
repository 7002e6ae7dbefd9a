// Moves an upright capsule among models, objects, bodies and other characters by sweeping it. Knows
// nothing of the ground, of speeds and of steps (character.hpp). Internal to physics. One thread.
#pragma once

#include <btBulletDynamicsCommon.h>

namespace psygen::physics {

// Result of a sweep.
struct Sweep {
  double fraction = 1;        // of the distance
  btVector3 normal{0, 1, 0};  // of the surface that was hit
  bool hit = false;
  const btCollisionObject* object = nullptr;  // the object that was hit
};

class CapsuleMover {
 public:
  // Distance that the capsule keeps from obstacles.
  static constexpr double kSkinM = 0.01;

  // `self` is the character's body, `mass_kg` its mass: lighter dynamic bodies are ignored. All
  // must outlive the mover.
  CapsuleMover(const btCollisionWorld& world, const btCollisionObject& self,
               const btConvexShape& capsule, double mass_kg)
      : world_(world), self_(self), capsule_(capsule), mass_kg_(mass_kg) {}

  // Sweeps the capsule's centre from one point to another. Ignores bodies that it moves away from.
  Sweep sweep(const btVector3& from, const btVector3& to) const;
  // Returns a position near `at` where the capsule overlaps nothing, as far as a few steps find
  // one.
  btVector3 pushed_out(const btVector3& at) const;
  // True if the other object blocks the character.
  bool stops(const btCollisionObject& other) const;

 private:
  const btCollisionWorld& world_;
  const btCollisionObject& self_;
  const btConvexShape& capsule_;
  double mass_kg_;
};

}  // namespace psygen::physics
