#include "engine/scene/objects/colliders.hpp"

#include <fmt/format.h>

#include <glm/common.hpp>
#include <utility>

#include "engine/scene/components.hpp"
#include "engine/scene/facts/world_facts.hpp"

namespace psygen::scene {

core::Result<ColliderId> Colliders::add(models::Collider collider, std::string_view name) {
  auto shape = query::Objects::make_shape(std::move(collider));
  if (!shape)
    return core::fail(shape.error().code, fmt::format("{}: {}", name, shape.error().message));
  shapes_.push_back(std::move(*shape));
  return ColliderId{static_cast<std::uint32_t>(shapes_.size() - 1)};
}

core::Result<ColliderId> Colliders::box_of(const Assets& assets, MeshId mesh) {
  if (!assets.exists(mesh))
    return core::invalid_argument(fmt::format("there is no mesh {} to take a box of", mesh.index));
  if (const auto known = boxes_.find(mesh.index); known != boxes_.end()) return known->second;
  const core::Bounds& box = assets.box(mesh);
  // Slightly above the minimum, because floats round.
  constexpr auto kMinHalf = static_cast<float>(0.501 * query::Objects::kMinSizeM);
  models::Collider collider;
  collider.shapes.emplace_back(
      core::Bounds::around(box.centre(), glm::max(box.half_extent(), glm::vec3(kMinHalf))));
  const auto added = add(std::move(collider), fmt::format("the box of mesh {}", mesh.index));
  if (added) boxes_.emplace(mesh.index, *added);
  return added;
}

void Colliders::follow(ecs::Entity entity, const Transform& transform, ObjectCollider& collider) {
  const query::ObjectPose pose{transform.position, glm::dquat(transform.rotation), transform.scale};
  const query::PlacedObject* object = objects_.find(collider.object);
  // A copied or loaded component refers to the object of another entity.
  const bool is_own = object != nullptr && object->name == owner_of(entity);
  if (is_own && collider.object_shape == collider.shape) {
    if (objects_.move(collider.object, pose)) return;
  } else if (collider.shape.index < shapes_.size()) {
    if (is_own) objects_.remove(collider.object);
    const auto added = objects_.add(owner_of(entity), shapes_[collider.shape.index], pose);
    collider.object = added.value_or(query::ObjectId());
    collider.object_shape = collider.shape;
    if (added) return;
  }
  // remove_stale() removes it, because it was not set.
  ++invalid_;
}

void Colliders::update(const WorldFacts& facts, Entities entities) {
  if (!std::exchange(opened_, true)) objects_ = query::Objects(facts.world);
  invalid_ = 0;
  entities.each([&](auto rows, auto transforms, auto colliders) {
    for (std::size_t i = 0; i < rows.size(); ++i)
      follow(rows[i], transforms[i], colliders[i]);
  });
  objects_.remove_stale();
}

core::Result<void> Colliders::add_systems(Systems& systems) {
  systems.step.add("colliders",
                   [this](const WorldFacts& facts, Entities entities) { update(facts, entities); });
  return {};
}

core::Result<void> Colliders::make_solid(ecs::World& entities, const Assets& assets,
                                         ecs::Entity entity) {
  const Object* object = entities.get<Object>(entity);
  if (object == nullptr || entities.get<Transform>(entity) == nullptr)
    return core::invalid_argument("an entity needs an Object and a Transform to become solid");
  const auto box = box_of(assets, object->mesh);
  if (!box) return tl::unexpected(box.error());
  if (entities.get<ObjectCollider>(entity) == nullptr)
    entities.add<ObjectCollider>(std::span(&entity, 1));
  entities.get<ObjectCollider>(entity)->shape = *box;
  return {};
}

}  // namespace psygen::scene
