// Things of a game that rays and bodies meet: colliders at their places, each with a name of the
// caller's. World::cast() finds them once World::meet() was told, and physics has them too. Values
// only: no mesh, no entities. Ordered in a tree: a move costs O(log n) where it leaves its leaf, a
// place that stays costs nothing. One thread. docs/queries.md.
#pragma once

#include <compare>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/query/box_tree.hpp"
#include "engine/query/solid.hpp"
#include "engine/world/world.hpp"

namespace psygen::query {

// What the caller calls an object. 0: none.
using ObjectName = std::uint64_t;

// An object of one Objects. Those of removed ones are recognised.
struct ObjectId {
  std::uint32_t slot = UINT32_MAX, generation = 0;
  friend auto operator<=>(const ObjectId&, const ObjectId&) = default;
};

// Where an object is. Its collider is scaled along its own axes first, then rotated. Spheres and
// the thickness of capsules are scaled by the largest of the three.
struct ObjectPose {
  core::WorldPosition position;     // need not be normalised
  glm::dquat rotation{1, 0, 0, 0};  // need not be unit
  glm::vec3 scale{1.0F};            // not 0; negative ones mirror
  bool operator==(const ObjectPose& other) const;
};

// A collider that was checked, for any number of objects.
using ObjectShape = std::shared_ptr<Solid>;

// An object as physics looks at it.
struct PlacedObject {
  ObjectName name = 0;
  ObjectPose pose;                  // as it was given
  core::WorldPosition position;     // normalised
  glm::dquat rotation{1, 0, 0, 0};  // of unit length
  ObjectShape shape;                // as it was given
  ObjectShape scaled;               // in metres from `position`, before the rotation
};

// Where a ray enters an object.
struct ObjectHit {
  ObjectId object;
  ObjectName name = 0;
  SolidHit hit;
};

// The objects of one world, which must outlive it. Movable.
class Objects {
 public:
  // Sizes of an object's parts after scaling, along any axis and from its place.
  static constexpr double kMinSizeM = 0.01, kMaxSizeM = 1000;
  static constexpr std::size_t kMaxParts = 64, kMaxHullPoints = 256;
  static constexpr std::size_t kMaxObjects = 1'000'000;

  Objects() = default;  // of no world: nothing can be added
  explicit Objects(const world::World& world) : world_(&world) {}

  // Checks a collider. Fails with kInvalidArgument, in a sentence that names the part, for
  // colliders without parts or of more than kMaxParts, values that are not finite, sizes outside
  // of kMinSizeM … kMaxSizeM, and hulls of less than four or more than kMaxHullPoints points,
  // or in one plane.
  static core::Result<ObjectShape> make_shape(models::Collider collider);

  // Adds an object. Fails with kInvalidArgument for a name of 0, poses that are not finite or
  // without a rotation, places outside a bounded world, and sizes out of their range after scaling;
  // with kOverBudget beyond kMaxObjects.
  core::Result<ObjectId> add(ObjectName name, const ObjectShape& shape, const ObjectPose& pose);
  // Another pose for an object. Fails like add(), and for objects that there are not; the object
  // stays where it was then. O(1) for the pose that it has.
  core::Result<void> move(ObjectId object, const ObjectPose& pose);
  // Whether there was one to remove.
  bool remove(ObjectId object);
  // Removes the objects that were neither added nor moved (also to where they are) since the last
  // call, for callers that tell of all again and again. Returns how many. O(objects).
  std::size_t remove_untold();

  // The object, or null. Valid until the next call that changes something.
  const PlacedObject* find(ObjectId object) const;
  std::size_t size() const { return tree_.size(); }

  // The first object on a ray of `longest_m` from a normalised place; the direction has unit
  // length. Of several at the same distance, the one with the least name.
  std::optional<ObjectHit> cast(const core::WorldPosition& origin, const glm::dvec3& direction,
                                double longest_m) const;
  // Replaces `out` by the objects whose boxes come near the box around a place, in ascending order.
  // It may have some more than overlap it, within BoxTree::kMarginM and what they move.
  void near(const core::WorldPosition& centre, const glm::dvec3& half_extent_m,
            std::vector<ObjectId>& out) const;

 private:
  struct Slot {
    PlacedObject object;
    BoxTree::Leaf leaf = 0;
    std::uint32_t generation = 0;
    bool lives = false, told = false;
  };
  core::Result<PlacedObject> placed(const ObjectPose& pose) const;
  WideBox box_of(const PlacedObject& object) const;
  // From the origin, to which the tree's boxes count.
  glm::dvec3 coordinates(const core::WorldPosition& at) const;

  const world::World* world_ = nullptr;
  core::BlockCoord origin_;  // the block of the first object: precision is best near it
  BoxTree tree_;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_;
};

}  // namespace psygen::query
