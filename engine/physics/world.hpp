// Rigid bodies and walking characters on the ground of a world, by Bullet. Ground, trunks, rocks
// and solid objects around everything that moves are made from queries before a step can reach
// them, whatever is drawn, and removed behind. Nothing falls through the ground: after each step,
// what crossed it is put back. Steps are fixed and deterministic: the same calls give the same bits
// in the same build. One thread. docs/physics.md.
#pragma once

#include <memory>
#include <optional>

#include "engine/core/error.hpp"
#include "engine/physics/types.hpp"
#include "engine/query/world.hpp"

namespace psygen::physics {

struct Settings {
  double gravity = 9.81;            // m/s², downwards; 0 … 100
  std::size_t max_bodies = 10'000;  // with characters
  // Blocks that nothing needs any more are kept for this many steps, and at most this many of them.
  std::uint32_t keep_steps = 120;
  std::size_t max_idle_blocks = 64;
};

// The physics of one world. Functions fail with kInvalidArgument for values that are not finite or
// out of their ranges, for positions outside a bounded world, and for names of nothing.
class World {
 public:
  // `query` must outlive it. Fails for settings out of their ranges.
  static core::Result<World> create(query::World& query, const Settings& settings = {});
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  // Adds a body. Its shape has at least one part, each of kMinSizeM … kMaxSizeM. Fails with
  // kOverBudget above Settings::max_bodies. A body below the ground is put on it in the next step.
  core::Result<BodyId> add(const BodySettings& settings);
  // Removes a body, and wakes those that touch it. O(contacts).
  core::Result<void> remove(BodyId body);
  core::Result<BodyState> state(BodyId body) const;
  // Teleports a body, and wakes it and what lies on it. A kinematic body moves there during the
  // next step and pushes what is in its way, if that is nearer than a block.
  core::Result<void> set_pose(BodyId body, const core::WorldPosition& position,
                              const glm::dquat& rotation);
  core::Result<void> set_velocity(BodyId body, const glm::dvec3& velocity, const glm::dvec3& spin);
  // Adds momentum, in kg·m/s, at the centre of mass of a dynamic body.
  core::Result<void> push(BodyId body, const glm::dvec3& impulse);

  // Adds a character. One below the ground is put on it at once.
  core::Result<CharacterId> add(const CharacterSettings& settings);
  core::Result<void> remove(CharacterId character);
  core::Result<CharacterState> state(CharacterId character) const;
  // Holds for all following steps; `jump` until the character has jumped.
  core::Result<void> tell(CharacterId character, const CharacterInput& input);
  // Teleports a character. Its ground is there at once.
  core::Result<void> set_feet(CharacterId character, const core::WorldPosition& feet);
  core::Result<void> set_velocity(CharacterId character, const glm::dvec3& velocity);

  // One step of `dt` seconds, in [0.001, 0.1]. Use the same `dt` always, 1 / 60 for example.
  core::Result<void> step(double dt);

  // The first body or character on a ray. Ground, models and objects are found by
  // query::World::cast().
  core::Result<std::optional<BodyHit>> cast(const core::WorldPosition& origin,
                                            const glm::dvec3& direction, double longest_m) const;

  // Blocks with ground and models in Bullet now.
  std::size_t block_count() const;

 private:
  struct Impl;
  explicit World(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace psygen::physics
