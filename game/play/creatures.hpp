// Deer, birds and fish: a few hundred around the player. Their homes are a function of the land, so
// they appear and disappear with the ground around the player. They flee from the player. They are
// not saved. Fixed steps, deterministic.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/query/world.hpp"
#include "game/play/land.hpp"

namespace cairns {

enum class Kind : std::uint8_t { kDeer, kBird, kFish };
inline constexpr std::size_t kKinds = 3;

struct Creature {
  Kind kind = Kind::kDeer;
  core::WorldPosition at, before;  // after the last step and after the previous one
  double yaw = 0, pitch = 0;       // radians, as in core::CameraPose
  double pace = 0;                 // speed in m/s
  double beat = 0;                 // phase of legs, wings or tail in radians
  double fear = 0;                 // 0 (calm) to 1 (fleeing)
  std::uint64_t seed = 0;
  core::WorldPosition home;  // centre of its range
  std::int32_t cell_x = 0, cell_z = 0;
  std::optional<query::Ground> ground;  // below it, since it moved
};

class Creatures {
 public:
  // `query` outlives it.
  explicit Creatures(query::World& query) : query_(&query) {}

  // Advances one step. `loud` is the player's speed in m/s: deer hear a running player from farther
  // away. `hour` is the hour of the day: birds sleep at night.
  void step(const core::WorldPosition& player, double loud, double hour, double dt);

  const std::vector<Creature>& all() const { return all_; }

 private:
  // A square of the land whose creatures come and go together.
  struct Cell {
    std::int32_t x = 0, z = 0;
    bool operator==(const Cell&) const = default;
  };
  // Removes creatures that are far away, and notes the cells that are near, the nearest last.
  void look_around(const core::WorldPosition& player);
  // Gives the last cell noted its creatures.
  void settle_next();
  void add_group(Kind kind, int count, const core::WorldPosition& home, std::uint64_t seed,
                 const Cell& cell);
  void step_deer(Creature& c, const glm::dvec3& to_player, double dt);
  void step_bird(Creature& c, const glm::dvec3& to_player, double hour, double dt);
  void step_fish(Creature& c, const glm::dvec3& to_player, double dt);
  // Looks up the ground below the creature if it has not moved yet. Returns false outside the
  // world.
  bool is_over_ground(Creature& c);
  // Moves the creature ahead if `may_be` accepts the ground there. Returns true if it moved.
  template <class MayBe>
  bool advance(Creature& c, double dt, const MayBe& may_be);

  query::World* query_;
  std::vector<Creature> all_;
  std::vector<Cell> settled_, near_;  // near_: those to settle
  std::uint64_t steps_ = 0;
};

}  // namespace cairns
