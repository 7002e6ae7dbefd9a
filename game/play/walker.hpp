// The player's body: a physics character that walks, runs, jumps, climbs, swims and glides. It
// chooses its gait from the ground, the water and the player's intent. It knows neither keys nor
// rendering. Steps are fixed and deterministic.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>

#include "engine/core/camera.hpp"
#include "engine/physics/world.hpp"
#include "engine/query/world.hpp"
#include "game/play/land.hpp"
#include "game/play/route.hpp"

namespace cairns {

// The player's input for one step, from any device or from the autopilot.
struct Intent {
  glm::dvec2 move{0.0};       // right and ahead; clamped to length 1
  double turn = 0, look = 0;  // radians to the right and up, in this step
  bool run = false;
  bool jump = false, jump_held = false;                              // pressed in this step; held
  bool use = false, use_held = false;                                // gather or fell
  bool build = false, fire = false, sleep = false, lantern = false;  // pressed
};

enum class Gait : std::uint8_t { kGround, kAir, kGlide, kSwim, kClimb };

inline constexpr double kEyesM = 1.65;

class Walker {
 public:
  // `physics` and `query` must outlive the walker. Fails like physics::World::add().
  static core::Result<Walker> create(physics::World& physics, query::World& query,
                                     const core::WorldPosition& feet);

  // Call before physics::World::step(). Sets the input of the physics character.
  void decide(const Intent& intent, const Abilities& abilities, const Weather& weather, double dt);
  // Call after physics::World::step(). Reads the new state of the character.
  void follow();
  // Teleports the player, and stops all motion.
  core::Result<void> put(const core::WorldPosition& feet, double yaw);

  const core::WorldPosition& feet() const { return feet_; }
  const glm::dvec3& velocity() const { return velocity_; }
  double yaw() const { return yaw_; }
  double pitch() const { return pitch_; }
  Gait gait() const { return gait_; }
  double breath() const { return breath_; }      // stamina for climbing, 0 to 1
  double walked_m() const { return walked_m_; }  // total distance
  // Events of the last step.
  bool stepped() const { return stepped_; }  // a foot touched the ground
  bool landed() const { return landed_; }
  bool splashed() const { return splashed_; }
  // Returns the eyes, interpolated between the last two steps; `share` is 0 to 1.
  core::CameraPose eyes(double share) const;

 private:
  Walker(physics::World& physics, query::World& query) : physics_(&physics), query_(&query) {}
  bool faces_wall() const;
  double depth_m() const;  // depth of the feet under water; negative above the surface
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
