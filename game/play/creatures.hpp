// Deer, birds and fish: a few hundred around the player, shaped and moved by code. Where they live
// is a function of the land; they come with the ground around the player and go with it. They flee
// from whoever comes near. Not saved. Deterministic in steps.
#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include "engine/query/world.hpp"
#include "game/play/land.hpp"

namespace cairns {

enum class Kind : std::uint8_t { kDeer, kBird, kFish };
inline constexpr std::size_t kKinds = 3;

struct Creature {
  Kind kind = Kind::kDeer;
  core::WorldPosition at, before;  // after the last step, and after the one before
  double yaw = 0, pitch = 0;       // as of a camera
  double pace = 0;                 // m/s
  double beat = 0;                 // of legs, wings or tail; radians
  double fear = 0;                 // 0 calm … 1 flees
  std::uint64_t seed = 0;
  core::WorldPosition home;  // that it stays around
  std::int32_t cell_x = 0, cell_z = 0;
};

class Creatures {
 public:
  // `query` outlives it.
  explicit Creatures(query::World& query) : query_(&query) {}

  // One step. `loud`: how fast the player is, in m/s; those who run are heard from farther away.
  // `hour` of the day: birds sleep at night.
  void step(const core::WorldPosition& player, double loud, double hour, double dt);

  const std::vector<Creature>& all() const { return all_; }

 private:
  void settle_cells(const core::WorldPosition& player);
  void settle(std::int32_t x, std::int32_t z);
  void add_group(Kind kind, int count, const core::WorldPosition& home, std::uint64_t seed,
                 std::int32_t x, std::int32_t z);
  void step_deer(Creature& c, const glm::dvec3& to_player, double dt);
  void step_bird(Creature& c, const glm::dvec3& to_player, double hour, double dt);
  void step_fish(Creature& c, const glm::dvec3& to_player, double dt);
  // Moves it ahead, unless `may_be` says no to the ground there. Whether it has.
  template <class MayBe>
  bool advance(Creature& c, double dt, const MayBe& may_be);

  query::World* query_;
  std::vector<Creature> all_;
  std::unordered_set<std::uint64_t> cells_;  // that have been settled
  std::uint64_t steps_ = 0;
};

}  // namespace cairns
