// What makes an object solid: a component that names a collider. Rays of query::World and bodies of
// physics::World meet it where the entity's Transform was at the end of the last fixed step. Needs
// no mesh, not even an Object. The game owns the Colliders; a game without any pays nothing. Main
// thread only. docs/objects.md.
#pragma once

#include <string_view>
#include <unordered_map>
#include <vector>

#include "engine/query/objects.hpp"
#include "engine/scene/scene.hpp"

namespace psygen::scene {

// Names a collider of Colliders.
struct ColliderId {
  std::uint32_t index = UINT32_MAX;  // UINT32_MAX: none
  friend bool operator==(const ColliderId&, const ColliderId&) = default;
};

// Which collider an entity has. It needs a Transform too.
struct ObjectCollider {
  ColliderId shape;
  // Where it is among the objects, and with which collider. Only the engine writes them.
  query::ObjectId object = {};
  ColliderId object_shape = {};
};

// The colliders of one scene by number, and its solid objects. Stays where it is.
class Colliders {
 public:
  // Of no scene yet.
  Colliders() = default;
  Colliders(const Colliders&) = delete;
  Colliders& operator=(const Colliders&) = delete;

  // Adds the system "colliders", which calls update() in each fixed step. Call it after adding the
  // systems of steps that move objects (app::Plugin::add_systems). It must outlive the scene.
  core::Result<void> add_systems(Systems& systems);

  // A collider in metres from the object's place, for any number of objects. Fails like
  // query::Objects::make_shape(); `name` is for the message.
  core::Result<ColliderId> add(models::Collider collider, std::string_view name = "collider");
  // The box of a mesh, at least 1 cm thick; the same collider for each call. Fails with
  // kInvalidArgument for meshes that there are not, and like add().
  core::Result<ColliderId> box_of(const Assets& assets, MeshId mesh);
  // Gives an entity with an Object the box of its mesh as collider, instead of any that it has.
  // Fails with kInvalidArgument for entities without an Object and a Transform, and like box_of().
  core::Result<void> make_solid(State& state, ecs::Entity entity);

  // Brings the objects to where the entities are, and removes those whose entities or components
  // are gone. For what was made or moved outside of a step. Always of the same world. O(entities
  // with a collider); moves cost most.
  using Entities = ecs::Query<const Transform, ObjectCollider>;
  void update(const WorldFacts& facts, Entities entities);
  void update(State& state) { update(state.facts, Entities(state.entities)); }

  // For query::World::meet(). Objects have the names owner_of(entity):
  // entity_of(query::Hit::object) is what a ray has hit. Look-ups recognise one that was destroyed
  // since the last update().
  const query::Objects& objects() const { return objects_; }
  // Entities that the last update() could not make solid: without such a collider, with a Transform
  // that is none, outside a bounded world, or scaled to a size out of range.
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
