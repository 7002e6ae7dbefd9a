// Objects of a game that rays and bodies collide with: colliders with poses, each with a name that
// the caller chooses. World::cast() finds the objects given to World::meet(), and so does physics.
// Values only: no mesh, no entities. Stored in a tree: a move costs O(log n) if it leaves its leaf;
// an object at rest costs nothing. One thread. docs/queries.md.
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

// The caller's number for an object. 0: none.
using ObjectTag = std::uint64_t;

// Identifies an object of one Objects. Ids of removed objects are recognised as stale.
struct ObjectId {
  std::uint32_t slot = UINT32_MAX, generation = 0;
  friend auto operator<=>(const ObjectId&, const ObjectId&) = default;
};

// Pose of an object. Its collider is scaled along its own axes first, then rotated. The largest
// component scales spheres and the thickness of capsules.
struct ObjectPose {
  core::WorldPosition position;     // need not be normalised
  glm::dquat rotation{1, 0, 0, 0};  // need not be unit
  glm::vec3 scale{1.0F};            // not 0; negative components mirror
  bool operator==(const ObjectPose& other) const;
};

// A checked collider, for any number of objects.
using ObjectShape = std::shared_ptr<Solid>;

// An object as physics uses it.
struct PlacedObject {
  ObjectTag name = 0;
  ObjectPose pose;                  // as given
  core::WorldPosition position;     // normalised
  glm::dquat rotation{1, 0, 0, 0};  // of unit length
  ObjectShape shape;                // as given
  ObjectShape scaled;               // in metres from `position`, before the rotation
};

// Intersection of a ray with an object.
struct ObjectHit {
  ObjectId object;
  ObjectTag name = 0;
  SolidHit hit;
};

// The objects of one world, which must outlive them. If the world is replaced by one with blocks of
// another size, the next add(), move() or remove_stale() names all objects by the new blocks at the
// places that they have (world::rebased()). Movable.
class Objects {
 public:
  // Limits of an object's parts after scaling: their size along any axis, and their reach from the
  // object's position.
  static constexpr double kMinSizeM = 0.01, kMaxSizeM = 1000;
  static constexpr std::size_t kMaxParts = 64, kMaxHullPoints = 256;
  static constexpr std::size_t kMaxObjects = 1'000'000;

  Objects() = default;  // without a world: add() fails
  explicit Objects(const world::World& world) : world_(&world), block_m_(world.block_size_m()) {}

  // Checks a collider. Fails with kInvalidArgument and a message that names the part, for colliders
  // without parts or with more than kMaxParts, values that are not finite, sizes outside of
  // kMinSizeM … kMaxSizeM, and hulls of less than four or more than kMaxHullPoints points, or
  // in one plane.
  static core::Result<ObjectShape> make_shape(models::Collider collider);

  // Adds an object. Fails with kInvalidArgument for a name of 0, poses that are not finite or
  // without a rotation, positions outside a bounded world, and sizes out of their range after
  // scaling; with kOverBudget beyond kMaxObjects.
  core::Result<ObjectId> add(ObjectTag name, const ObjectShape& shape, const ObjectPose& pose);
  // Changes the pose of an object. Fails like add(), and for unknown objects; the object then
  // stays. O(1) if the pose is equal.
  core::Result<void> move(ObjectId object, const ObjectPose& pose);
  // Returns false if the object did not exist.
  bool remove(ObjectId object);
  // Removes the objects that were neither added nor moved (an equal pose counts) since the last
  // call, for callers that set all objects repeatedly. Returns their number. O(objects).
  std::size_t remove_stale();

  // The object, or null. Valid until the next call of a function that is not const.
  const PlacedObject* find(ObjectId object) const;
  std::size_t size() const { return tree_.size(); }

  // Returns the first object on a ray of `longest_m` from a normalised position. The direction has
  // unit length. Of several objects at the same distance, the one with the smallest name.
  std::optional<ObjectHit> cast(const core::WorldPosition& origin, const glm::dvec3& direction,
                                double longest_m) const;
  // Replaces `out` by the objects whose boxes are near the box around a position, in ascending
  // order. It may have a few objects more than overlap it, within BoxTree::kMarginM and the
  // distance of their moves.
  void near(const core::WorldPosition& centre, const glm::dvec3& half_extent_m,
            std::vector<ObjectId>& out) const;

 private:
  struct Slot {
    PlacedObject object;
    BoxTree::Leaf leaf = 0;
    std::uint32_t generation = 0;
    bool lives = false, told = false;
  };
  void follow_world();
  core::Result<PlacedObject> placed(const ObjectPose& pose) const;
  WideBox box_of(const PlacedObject& object) const;
  // Metres from the origin, in the coordinates of the tree's boxes.
  glm::dvec3 coordinates(const core::WorldPosition& at) const;

  const world::World* world_ = nullptr;
  double block_m_ = 0;       // of the blocks that positions refer to
  core::BlockCoord origin_;  // the block of the first object: precision is highest near it
  BoxTree tree_;
  std::vector<Slot> slots_;
  std::vector<std::uint32_t> free_;
};

}  // namespace psygen::query
