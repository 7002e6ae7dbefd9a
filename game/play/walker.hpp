// The player's body: walks, runs, jumps, climbs, swims and glides. A character of physics, told
// every step how to move; it decides which of these it does from the ground, the water, and what
// the player wants. Knows neither keys nor pictures. Steps are fixed and deterministic.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

#include "engine/core/camera.hpp"
#include "engine/physics/world.hpp"
#include "engine/query/world.hpp"
#include "game/play/story.hpp"
#include "game/play/weather.hpp"

namespace cairns {

// What the player wants in one step, from whatever device, or from the pilot.
struct Intent {
  glm::dvec2 move{0.0};       // to the right and ahead; longer than 1 counts as 1
  double turn = 0, look = 0;  // radians to the right and upwards, in this step
  bool run = false;
  bool jump = false, jump_held = false;                              // pressed in this step; held
  bool use = false, use_held = false;                                // gathers, fells
  bool build = false, fire = false, sleep = false, lantern = false;  // pressed
};

enum class Gait : std::uint8_t { kGround, kAir, kGlide, kSwim, kClimb };

inline constexpr double kEyesM = 1.65;

class Walker {
 public:
  // Both outlive it. Fails as physics::World::add().
  static core::Result<Walker> create(physics::World& physics, query::World& query,
                                     const core::WorldPosition& feet);

  // Before physics::World::step(): what the body is told.
  void decide(const Intent& intent, const Abilities& abilities, const Weather& weather, double dt);
  // After it: what came of it.
  void follow();
  // Teleports; nothing of its motion is left.
  core::Result<void> put(const core::WorldPosition& feet, double yaw);

  const core::WorldPosition& feet() const { return feet_; }
  const glm::dvec3& velocity() const { return velocity_; }
  double yaw() const { return yaw_; }
  double pitch() const { return pitch_; }
  Gait gait() const { return gait_; }
  double breath() const { return breath_; }      // for climbing: 0 … 1
  double walked_m() const { return walked_m_; }  // in all
  // What happened in the last step.
  bool stepped() const { return stepped_; }  // a foot came down
  bool landed() const { return landed_; }
  bool splashed() const { return splashed_; }
  // The eyes, `share` of a step after the step before the last.
  core::CameraPose eyes(double share) const;

 private:
  Walker(physics::World& physics, query::World& query) : physics_(&physics), query_(&query) {}
  bool faces_wall() const;
  double depth_m() const;  // of the feet below the water's surface; below 0: above it
  Gait next_gait(const Intent& intent, const Abilities& abilities) const;
  physics::CharacterInput walk(const Intent& intent, const Abilities& abilities) const;
  physics::CharacterInput glide(const Abilities& abilities, const Intent& intent,
                                const Weather& weather);

  physics::World* physics_;
  query::World* query_;
  physics::CharacterId body_;
  core::WorldPosition feet_, before_;
  glm::dvec3 velocity_{0.0};
  double yaw_ = 0, pitch_ = 0, yaw_before_ = 0, pitch_before_ = 0, breath_ = 1, walked_m_ = 0,
         stride_m_ = 0, gust_s_ = 0;
  Gait gait_ = Gait::kGround;
  bool on_ground_ = true, stepped_ = false, landed_ = false, splashed_ = false;
};

}  // namespace cairns
