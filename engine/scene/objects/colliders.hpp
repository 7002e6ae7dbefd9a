// Solid objects: a component that names a collider. Rays of query::World and bodies of
// physics::World hit it at the entity's Transform of the last fixed step. Needs no mesh, not even
// an Object. The game owns the Colliders; a game without them pays nothing. Main thread only. See
// docs/objects.md.
#pragma once

#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/query/objects.hpp"
#include "engine/scene/objects/assets.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {

struct WorldFacts;

// The number of a collider in Colliders.
struct ColliderId {
  std::uint32_t index = UINT32_MAX;  // UINT32_MAX: none
  friend bool operator==(const ColliderId&, const ColliderId&) = default;
};

// The collider of an entity. The entity needs a Transform too.
struct ObjectCollider {
  ColliderId shape;
  // Its place among the objects, and the collider it has there. Only the engine writes them.
  query::ObjectId object = {};
  ColliderId object_shape = {};
};

// The colliders of one scene by number, and its solid objects. Cannot be moved.
class Colliders {
 public:
  // Belongs to no scene yet.
  Colliders() = default;
  Colliders(const Colliders&) = delete;
  Colliders& operator=(const Colliders&) = delete;

  // Adds the system "colliders", which calls update() in each fixed step. Call it after adding the
  // step systems that move objects (app::Plugin::add_systems). The Colliders must outlive the
  // scene.
  core::Result<void> add_systems(Systems& systems);

  // Adds a collider, in metres from the object's origin, for any number of objects. Fails as
  // query::Objects::make_shape(); `name` is for the message.
  core::Result<ColliderId> add(models::Collider collider, std::string_view name = "collider");
  // Returns a collider with the bounds of a mesh, at least 1 cm thick; the same one for each call.
  // Fails with kInvalidArgument for meshes that do not exist, and as add().
  core::Result<ColliderId> box_of(const Assets& assets, MeshId mesh);
  // Gives an entity with an Object the box of its mesh as its collider. Fails with kInvalidArgument
  // for entities without an Object and a Transform, and as box_of().
  core::Result<void> make_solid(ecs::World& entities, const Assets& assets, ecs::Entity entity);

  // Moves the objects to their entities, and removes those whose entities or components are gone.
  // Call it after changes outside of a step, always with the same world. O(entities with a
  // collider); moves cost most.
  using Entities = ecs::Query<const Transform, ObjectCollider>;
  void update(const WorldFacts& facts, Entities entities);
  void update(const WorldFacts& facts, ecs::World& entities) { update(facts, Entities(entities)); }

  // For query::World::set_objects(). An object's tag is owner_of(entity), so
  // entity_of(query::Hit::object) is the entity that a ray has hit. Look-ups recognise one that was
  // destroyed since the last update().
  const query::Objects& objects() const { return objects_; }
  // Number of entities that the last update() could not make solid: without such a collider, with
  // an invalid Transform, outside a bounded world, or scaled out of range.
  std::uint32_t invalid() const { return invalid_; }

 private:
  void follow(ecs::Entity entity, const Transform& transform, ObjectCollider& collider);

  query::Objects objects_;
  bool opened_ = false;
  std::vector<query::ObjectShape> shapes_;
  std::unordered_map<std::uint32_t, ColliderId> boxes_;  // by mesh
  std::uint32_t invalid_ = 0;
};

}  // namespace psygen::scene
