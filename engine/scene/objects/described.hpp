// Field descriptions of the components that a game gives its entities, for snapshots and saves
// (ecs/fields.hpp, docs/saves.md). Leaves out state that only the engine writes. Included by the
// components' headers.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "ecs/fields.hpp"
#include "engine/core/coordinates.hpp"

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
