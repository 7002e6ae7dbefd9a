// Rigid bodies and walking characters on the ground of a world, by Bullet. Before each step,
// queries supply the ground, trunks, rocks and solid objects within reach of everything that moves,
// whatever is drawn; unused blocks are removed. Nothing falls through the ground: after each step,
// bodies that crossed it are lifted back. Steps are fixed and deterministic: the same calls give
// the same bits in the same build. One thread. docs/physics.md.
#pragma once

#include <memory>
#include <optional>

#include "engine/core/error.hpp"
#include "engine/physics/types.hpp"
#include "engine/query/world.hpp"

namespace psygen::physics {

struct Settings {
  double gravity = 9.81;            // m/s², downwards; 0 … 100
  double water_kg_m3 = 1000;        // density of water, 0 … 20,000; 0: water has no effect
  std::size_t max_bodies = 10'000;  // characters included
  // Idle blocks are kept for this many steps, and at most this many blocks.
  std::uint32_t keep_steps = 120;
  std::size_t max_idle_blocks = 64;
};

// The physics of one world. It follows edits and the replacement of that world as its queries do:
// bodies and characters keep their places in metres, and those below the new ground are lifted onto
// it. Functions fail with kInvalidArgument for values that are not finite or
// out of their ranges, for positions outside a bounded world, and for ids that do not exist.
class World {
 public:
  // `query` must outlive the result. Fails for settings out of their ranges.
  static core::Result<World> create(query::World& query, const Settings& settings = {});
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;
  ~World();

  // Positions across the seam of an endless world from other objects fail with kInvalidArgument, in
  // both add(), set_pose() and set_feet().

  // Adds a body. Its shape has at least one part, each of kMinSizeM … kMaxSizeM. Fails with
  // kOverBudget above Settings::max_bodies. The next step lifts a body below the ground onto it.
  core::Result<BodyId> add(const BodySettings& settings);
  // Removes a body, and wakes the bodies that touch it. O(contacts).
  core::Result<void> remove(BodyId body);
  core::Result<BodyState> state(BodyId body) const;
  // Teleports a body, and wakes it and the bodies on it. A kinematic body moves to the pose during
  // the next step and pushes bodies in its path, if the distance is less than a block.
  core::Result<void> set_pose(BodyId body, const core::WorldPosition& position,
                              const glm::dquat& rotation);
  core::Result<void> set_velocity(BodyId body, const glm::dvec3& velocity, const glm::dvec3& spin);
  // Adds momentum, in kg·m/s, at the centre of mass of a dynamic body.
  core::Result<void> push(BodyId body, const glm::dvec3& impulse);

  // Adds a character. One below the ground is put on it immediately.
  core::Result<CharacterId> add(const CharacterSettings& settings);
  core::Result<void> remove(CharacterId character);
  core::Result<CharacterState> state(CharacterId character) const;
  // Sets the input for all following steps; `jump` applies until the character has jumped.
  core::Result<void> tell(CharacterId character, const CharacterInput& input);
  // Teleports a character. Its ground is loaded immediately.
  core::Result<void> set_feet(CharacterId character, const core::WorldPosition& feet);
  core::Result<void> set_velocity(CharacterId character, const glm::dvec3& velocity);

  // Runs one step of `dt` seconds, in [0.001, 0.1]. Always use the same `dt`, for example 1 / 60.
  core::Result<void> step(double dt);

  // Returns the first body or character on a ray. query::World::cast() finds ground, models and
  // objects.
  core::Result<std::optional<BodyHit>> cast(const core::WorldPosition& origin,
                                            const glm::dvec3& direction, double longest_m) const;

  // Number of blocks whose ground and models are in Bullet now.
  std::size_t block_count() const;

 private:
  struct Impl;
  explicit World(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace psygen::physics
