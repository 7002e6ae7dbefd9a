// Game objects in Bullet: those near bodies and characters, as kinematic bodies that follow
// query::Objects in each step. They push dynamic bodies and carry bodies on top of them, and
// nothing moves them. Internal to physics. One thread.
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
  // Called before an object is removed or starts to move: bodies that touch it must wake.
  using Wake = std::function<void(const btCollisionObject&)>;

  // All arguments must outlive it.
  ObjectBodies(btDynamicsWorld& bullet, const query::World& query, const Terrain& terrain,
               Wake wake);
  ~ObjectBodies();
  ObjectBodies(const ObjectBodies&) = delete;
  ObjectBodies& operator=(const ObjectBodies&) = delete;

  // Moves all bodies to the present poses of their objects, and removes bodies of removed objects.
  void follow(double dt);
  // Adds the missing bodies of objects near a box in Bullet's coordinates, and keeps all of them
  // for this step.
  void need(const btVector3& low, const btVector3& high, std::uint64_t step);
  // Removes bodies that were not needed for `keep_steps`.
  void drop_idle(std::uint64_t step, std::uint32_t keep_steps);
  // Adapts to a move of Bullet's origin by `by`.
  void shift(const btVector3& by);
  // Returns the displacement of a point on an object in the last follow(). Zero for objects that
  // are missing, and for those that jumped.
  btVector3 way_of(query::ObjectId object, const btVector3& point) const;
  std::size_t size() const { return bodies_.size(); }

 private:
  // `motion` and `shape` must outlive `rigid`.
  struct Body {
    query::ObjectShape solid;  // source of `shape`
    OwnedShape shape;
    btDefaultMotionState motion;
    std::unique_ptr<btRigidBody> rigid;
    btTransform before;   // pose before the step
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

// Returns the object of a body with the group kObjects; none for other bodies.
query::ObjectId object_of(const btCollisionObject& body);

}  // namespace psygen::physics
