// The values of physics: bodies, characters, rays. Plain values without Bullet's types. Metres,
// seconds, kilograms; +Y is up.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "engine/core/coordinates.hpp"
#include "engine/models/collider.hpp"

namespace psygen::physics {

// Identifies a body or character of one World. Numbers of removed ones are never reused.
struct BodyId {
  std::uint32_t number = 0;  // 0: none
  friend auto operator<=>(const BodyId&, const BodyId&) = default;
};
struct CharacterId {
  std::uint32_t number = 0;  // 0: none
  friend auto operator<=>(const CharacterId&, const CharacterId&) = default;
};

// Limits of all values.
inline constexpr double kMaxSpeed = 1000;  // m/s; a step slows faster bodies down
inline constexpr double kMaxSizeM = 1000;  // of a shape, along any axis
inline constexpr double kMinSizeM = 0.01;

// The way in which a body moves.
enum class Motion : std::uint8_t {
  kDynamic,    // by forces
  kKinematic,  // by set_pose(); pushes dynamic bodies and blocks characters
};

// A body to be added.
struct BodySettings {
  models::Collider shape;  // around the body's position, which is its centre of mass
  Motion motion = Motion::kDynamic;
  core::WorldPosition position;
  glm::dquat rotation{1, 0, 0, 0};
  glm::dvec3 velocity{0.0}, spin{0.0};  // m/s, rad/s
  double mass_kg = 1;                   // above 0; unused for kKinematic
  double friction = 0.6;                // 0 … 10
  double restitution = 0;               // 0 … 1
};

// A body after a step.
struct BodyState {
  core::WorldPosition position;  // normalised
  glm::dquat rotation{1, 0, 0, 0};
  glm::dvec3 velocity{0.0}, spin{0.0};
  bool asleep = false;
};

// A character to be added: an upright, walking capsule.
struct CharacterSettings {
  core::WorldPosition feet;
  double radius_m = 0.3, height_m = 1.8;  // height >= 2 · radius
  double walk_speed = 1.6, run_speed = 5;
  double jump_speed = 4.5;  // upwards, at the start of a jump
  double step_height_m = 0.4;
  double max_slope_deg = 50;  // 0 … 89: steepest ground that it climbs and stands on
  double mass_kg = 80;        // lighter bodies are pushed aside, heavier ones stop it
};

// Commands to a character for the following steps.
struct CharacterInput {
  glm::dvec2 direction{0.0};  // x and z; longer than 1 counts as 1
  bool run = false;
  bool jump = false;  // at the next moment on the ground
  double speed = 0;   // m/s in `direction`; 0: walk_speed or run_speed. 0 … kMaxSpeed
  // Vertical speed in m/s, which replaces gravity: the character swims, climbs or glides. Ground
  // and models stop it as always. −kMaxSpeed … kMaxSpeed.
  std::optional<double> rise = std::nullopt;
};

// A character after a step.
struct CharacterState {
  core::WorldPosition feet;  // normalised
  glm::dvec3 velocity{0.0};
  bool on_ground = false;  // stands on ground, a model or a body
};

// The body or character that a ray hit.
struct BodyHit {
  BodyId body;            // or
  CharacterId character;  // the other one is 0
  double distance_m = 0;
  core::WorldPosition position;
  glm::dvec3 normal{0, 1, 0};
};

}  // namespace psygen::physics
