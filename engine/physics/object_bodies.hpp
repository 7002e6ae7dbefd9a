// The objects of a game that physics has in Bullet: those near bodies and characters, as kinematic
// bodies that follow query::Objects in each step. They push dynamic bodies and carry what stands on
// them, and nothing moves them. Internal to physics. One thread.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "engine/physics/shapes.hpp"
#include "engine/physics/terrain.hpp"
#include "engine/query/objects.hpp"

namespace psygen::physics {

class ObjectBodies {
 public:
  // Called before an object goes or begins to move: what touches it has to wake.
  using Wake = std::function<void(const btCollisionObject&)>;

  // All must outlive it.
  ObjectBodies(btDynamicsWorld& bullet, const query::World& query, const Terrain& terrain,
               Wake wake);
  ~ObjectBodies();
  ObjectBodies(const ObjectBodies&) = delete;
  ObjectBodies& operator=(const ObjectBodies&) = delete;

  // Moves all to where their objects are now, and removes those whose objects are gone.
  void follow(double dt);
  // Adds what is missing of the objects near a box in Bullet's coordinates, and keeps them for this
  // step.
  void need(const btVector3& low, const btVector3& high, std::uint64_t step);
  // Removes those that were not needed for `keep_steps`.
  void drop_idle(std::uint64_t step, std::uint32_t keep_steps);
  // Bullet's coordinates have moved by −`by`.
  void shift(const btVector3& by);
  // How an object has carried a point on it in the last follow(). Zero for objects that are not
  // there, and for those that jumped.
  btVector3 way_of(query::ObjectId object, const btVector3& point) const;
  std::size_t size() const { return bodies_.size(); }

 private:
  // `motion` and `shape` must outlive `rigid`.
  struct Body {
    query::ObjectShape solid;  // that `shape` was made of
    OwnedShape shape;
    btDefaultMotionState motion;
    std::unique_ptr<btRigidBody> rigid;
    btTransform before;   // the step
    bool carries = true;  // false: it jumped
    std::uint64_t needed = 0;
  };
  using Bodies = std::map<query::ObjectId, std::unique_ptr<Body>>;

  btTransform pose_of(const query::PlacedObject& object) const;
  void add(query::ObjectId id, const query::PlacedObject& object, std::uint64_t step);
  void move(Body& body, const btTransform& pose, double dt);
  Bodies::iterator erase(Bodies::iterator body);

  btDynamicsWorld& bullet_;
  const query::World& query_;
  const Terrain& terrain_;
  Wake wake_;
  Bodies bodies_;  // in order, for determinism
  std::vector<query::ObjectId> near_;
};

// The object of a body with the group kObjects; none for other bodies.
query::ObjectId object_of(const btCollisionObject& body);

}  // namespace psygen::physics
