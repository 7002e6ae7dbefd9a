// Moves an upright capsule among models, objects, bodies and other characters by sweeping it. Knows
// nothing of the ground, of speeds and of steps (character.hpp). Internal to physics. One thread.
#pragma once

#include <btBulletDynamicsCommon.h>

namespace psygen::physics {

// How far a sweep came.
struct Sweep {
  double fraction = 1;        // of the way
  btVector3 normal{0, 1, 0};  // of what was hit
  bool hit = false;
  const btCollisionObject* object = nullptr;  // that was hit
};

class CapsuleMover {
 public:
  // The capsule keeps this distance from what it meets.
  static constexpr double kSkinM = 0.01;

  // `self` is the character's body, `mass_kg` its mass: lighter dynamic bodies are ignored. All
  // must outlive it.
  CapsuleMover(const btCollisionWorld& world, const btCollisionObject& self,
               const btConvexShape& capsule, double mass_kg)
      : world_(world), self_(self), capsule_(capsule), mass_kg_(mass_kg) {}

  // Sweeps the capsule's centre from one point to another. What it moves away from is ignored.
  Sweep sweep(const btVector3& from, const btVector3& to) const;
  // Where a capsule at `at` has to go to overlap nothing, as far as a few steps find it.
  btVector3 pushed_out(const btVector3& at) const;
  // Whether something is in the way of the character.
  bool stops(const btCollisionObject& other) const;

 private:
  const btCollisionWorld& world_;
  const btCollisionObject& self_;
  const btConvexShape& capsule_;
  double mass_kg_;
};

}  // namespace psygen::physics
