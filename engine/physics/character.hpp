// A walking character: speeds, slopes, steps, jumps. It follows the ground by exact queries, and
// everything else by sweeps of its capsule. Internal to physics. One thread.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>

#include "engine/physics/buoyancy.hpp"
#include "engine/physics/capsule_mover.hpp"
#include "engine/physics/object_bodies.hpp"
#include "engine/physics/terrain.hpp"
#include "engine/physics/types.hpp"

namespace psygen::physics {

// One character with its kinematic body, which pushes lighter bodies.
class Character {
 public:
  // Adds the body to `bullet`, which must outlive it. `feet` are in Bullet's coordinates.
  Character(btDynamicsWorld& bullet, Terrain& terrain, const CharacterSettings& settings,
            const btVector3& feet, std::uint32_t number);
  ~Character();
  Character(const Character&) = delete;
  Character& operator=(const Character&) = delete;

  // Moves the character for `dt` seconds. `carried` is the displacement of the object that it
  // stands on in this time, `water` the water at its feet.
  void step(double dt, double gravity, const btVector3& carried, const WaterHere& water);
  // Teleports the character, but not below the ground and not beyond the walls of a bounded world.
  void teleport(const btVector3& feet);
  // Adapts to a move of Bullet's origin by `by`.
  void shift(const btVector3& by);

  const btVector3& feet() const { return feet_; }
  // The object that the character stands on, or none.
  query::ObjectId floor() const { return on_ground ? floor_ : query::ObjectId(); }
  double reach_m() const { return settings_.height_m + settings_.step_height_m; }

  CharacterInput input;
  btVector3 velocity{0, 0, 0};
  bool on_ground = false;

 private:
  struct Support {
    double height;
    btVector3 normal;
  };
  btVector3 centre(const btVector3& feet) const {
    return feet + btVector3(0, 0.5 * settings_.height_m, 0);
  }
  btVector3 climb_limited(const btVector3& way);
  bool step_up(const btVector3& way);
  void stop_at(const btVector3& normal);
  void move_aside(btVector3 way);
  void move_up(double rise);
  bool is_in_hollow();
  void move_down(double drop);
  void follow_ground();
  void ride(const btVector3& carried);
  void leave_floor();
  bool is_walkable(const btVector3& normal) const { return normal.y() >= min_up_; }
  double submerged(const WaterHere& water) const;
  void fall(double dt, double gravity, double under);
  void publish(bool jumped_there);

  btDynamicsWorld& bullet_;
  Terrain& terrain_;
  CharacterSettings settings_;
  double min_up_;  // y of the normal of the steepest walkable ground
  btVector3 feet_;
  bool rising_ = false;  // has jumped in this step
  query::ObjectId floor_;
  btVector3 floor_velocity_{0, 0, 0};
  bool on_edge_ = false;  // on the edge of a step that it climbs
  btCapsuleShape capsule_;
  btDefaultMotionState motion_;
  std::unique_ptr<btRigidBody> body_;
  CapsuleMover mover_;
};

}  // namespace psygen::physics
