// Visible entities of a game. An entity with a Transform and an Object is drawn, culled, shadowed
// and faded until it is destroyed:
//   world.create<Transform, Object>(1)
// or scene::spawn(). Meshes and materials come from the scene's Assets (assets.hpp). Plain data;
// main thread only.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "ecs/ecs.hpp"
#include "ecs/fields.hpp"
#include "engine/core/coordinates.hpp"
#include "engine/render/types.hpp"

// Field descriptions for snapshots and saves (ecs/fields.hpp, docs/saves.md), of these types and of
// the components below. They leave out state that only the engine writes.

// Vectors, rotations and positions, by their numbers.
template <>
struct psygen::ecs::ComponentTraits<glm::vec3> {
  static constexpr auto fields =
      std::tuple{field("x", &glm::vec3::x), field("y", &glm::vec3::y), field("z", &glm::vec3::z)};
};

// As above.
template <>
struct psygen::ecs::ComponentTraits<glm::dvec3> {
  static constexpr auto fields = std::tuple{field("x", &glm::dvec3::x), field("y", &glm::dvec3::y),
                                            field("z", &glm::dvec3::z)};
};

// As above.
template <>
struct psygen::ecs::ComponentTraits<glm::quat> {
  static constexpr auto fields = std::tuple{field("w", &glm::quat::w), field("x", &glm::quat::x),
                                            field("y", &glm::quat::y), field("z", &glm::quat::z)};
};

// As above.
template <>
struct psygen::ecs::ComponentTraits<psygen::core::BlockCoord> {
  static constexpr auto fields =
      std::tuple{field("x", &core::BlockCoord::x), field("z", &core::BlockCoord::z)};
};

// As above.
template <>
struct psygen::ecs::ComponentTraits<psygen::core::WorldPosition> {
  static constexpr auto fields = std::tuple{field("block", &core::WorldPosition::block),
                                            field("local", &core::WorldPosition::local)};
};

namespace psygen::scene {

// The number of a mesh in Assets. A scene never uses a number twice.
struct MeshId {
  std::uint32_t index = UINT32_MAX;  // UINT32_MAX: none
  friend bool operator==(const MeshId&, const MeshId&) = default;
};

// The place of an entity. An object with numbers that are not finite, without a rotation, or with a
// scale outside of 10⁻⁴ … 10⁴ is not drawn (ObjectCounts::invalid).
struct Transform {
  core::WorldPosition position;                // need not be normalised
  glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};  // w, x, y, z; need not be unit
  glm::vec3 scale{1.0F};                       // before the rotation; negative ones mirror
};

// The draw state of an object. Only the engine writes it (objects_system).
struct ObjectState {
  static constexpr std::uint8_t kNoLevel = 0xFF;
  float share = 0;                          // fraction of its pixels that are drawn
  float sun = 1;                            // fraction of sunlight that no terrain hides
  std::uint32_t drawn_tick = UINT32_MAX;    // the last one in which it was drawn
  std::uint32_t in_view_tick = UINT32_MAX;  // the last one in which it was in view
  std::uint8_t level = kNoLevel;            // of detail that is drawn
  std::uint8_t old_level = kNoLevel;        // LOD that it replaces, until `share` is 1
  bool fresh = true;                        // never in view so far
};

// The look of an entity.
struct Object {
  MeshId mesh;
  render::MaterialId material =
      render::kPlainMaterial;  // also drawn for a material that does not exist
  bool visible = true;         // false: fades out and stays hidden
  ObjectState state = {};
};
static_assert(sizeof(Object) == 32);

}  // namespace psygen::scene

// Saves its index.
template <>
struct psygen::ecs::ComponentTraits<psygen::scene::MeshId> {
  static constexpr auto fields = std::tuple{field("index", &scene::MeshId::index)};
};

// All of it.
template <>
struct psygen::ecs::ComponentTraits<psygen::scene::Transform> {
  static constexpr std::string_view name = "Transform";
  static constexpr auto fields = std::tuple{field("position", &scene::Transform::position),
                                            field("rotation", &scene::Transform::rotation),
                                            field("scale", &scene::Transform::scale)};
};

// Saves meshes and materials by number: make the same calls of Assets in the same order before
// loading.
template <>
struct psygen::ecs::ComponentTraits<psygen::scene::Object> {
  static constexpr std::string_view name = "Object";
  static constexpr auto fields =
      std::tuple{field("mesh", &scene::Object::mesh), field("material", &scene::Object::material),
                 field("visible", &scene::Object::visible)};
};

namespace psygen::scene {

// Creates an object: an entity with a Transform and an Object.
inline ecs::Entity spawn(ecs::World& world, const Object& object, const Transform& transform) {
  const auto made = world.create<Transform, Object>(1);
  made.column<Transform>()[0] = transform;
  made.column<Object>()[0] = object;
  return made.entities[0];
}

}  // namespace psygen::scene
