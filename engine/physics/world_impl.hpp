// Implementation of physics::World: Bullet's world, the terrain, bodies and characters by number,
// and the step. Internal to physics. One thread.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <map>
#include <memory>

#include "engine/physics/buoyancy.hpp"
#include "engine/physics/character.hpp"
#include "engine/physics/ground_contacts.hpp"
#include "engine/physics/object_bodies.hpp"
#include "engine/physics/shapes.hpp"
#include "engine/physics/terrain.hpp"
#include "engine/physics/world.hpp"

namespace psygen::physics {

struct World::Impl {
  // A body; `motion` must outlive `rigid`.
  struct Body {
    OwnedShape shape;
    Motion kind = Motion::kDynamic;
    double reach_m = 0;  // radius of a ball around the centre that holds the shape
    Displacement displacement;
    btDefaultMotionState motion;
    std::unique_ptr<btRigidBody> rigid;
    btTransform before;     // pose before the step
    bool is_moved = false;  // true if a kinematic body has a new pose for the next step
  };

  // `queries` must outlive it; the settings are legal.
  Impl(query::World& queries, const Settings& wanted);
  ~Impl();

  // Returns Bullet's coordinates of a position. Moves the origin there if nothing is near the
  // present one. `others`: bodies and characters besides the one to place. Fails outside a bounded
  // world, for values that are not finite, and across the seam from any others.
  core::Result<btVector3> place(const core::WorldPosition& at, std::size_t others);
  Body* find(BodyId id);
  Character* find(CharacterId id);
  std::size_t count() const { return bodies.size() + characters.size(); }

  void step(double dt);
  void shift_origin();
  void move_origin(core::BlockCoord to);
  // Reduces the coordinates of everything that is not terrain.
  void shift(const btVector3& by);
  // Adapts to a replaced world: drops its terrain, wakes all bodies, and lifts bodies and
  // characters that are below the new ground. All functions of World that use positions call it
  // first.
  void follow_world();
  // Loads ground, models and objects wherever something can move in this step.
  void make_surroundings(double dt);
  // Fails with kOverBudget if the settings allow no more bodies and characters.
  core::Result<void> check_room() const;
  // Puts fast bodies back to where their paths of this step meet an object.
  void stop_at_impacts();
  void lift_above_ground(Body& body);
  // Wakes the dynamic bodies that touch an object, which will be removed.
  void wake_touching(const btCollisionObject& object);
  // Removes terrain that edits changed, and wakes the bodies that may be on it or in it.
  void sync_edits();

  query::World& query;
  Settings settings;
  GroundConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld bullet{&dispatcher, &broadphase, &solver, &configuration};
  Terrain terrain{bullet, query};
  ObjectBodies objects{bullet, query, terrain,
                       [this](const btCollisionObject& object) { wake_touching(object); }};
  std::map<std::uint32_t, Body> bodies;  // in order of number, for determinism
  std::map<std::uint32_t, Character> characters;
  std::uint32_t last_number = 0;
  std::uint64_t steps = 0;
};

// True if every component is finite and its absolute value at most `most`.
bool is_within(const glm::dvec3& v, double most);

}  // namespace psygen::physics
