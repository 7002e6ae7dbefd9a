// A game of Cairns, without pictures, sound or keys: the land, the player in it, what was found,
// gathered, built, felled and lit. It has a copy of the world, with the edits that the player made,
// and queries and physics of its own, so it follows from its seed and the intents of its steps
// alone: the same to the bit in the same build, at every frame rate, with or without a renderer.
// One thread.
#pragma once

#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "engine/physics/world.hpp"
#include "engine/query/world.hpp"
#include "engine/world/edits/edits.hpp"
#include "game/play/creatures.hpp"
#include "game/play/route.hpp"
#include "game/play/story.hpp"
#include "game/play/walker.hpp"
#include "game/play/weather.hpp"

namespace cairns {

// What the player carries.
struct Stock {
  int stones = 0, wood = 0;
};

// A fire that burns until a time of the game.
struct Fire {
  core::WorldPosition at;
  double until_s = 0;
};

// What can be used where the player stands.
struct Target {
  enum class Kind : std::uint8_t { kNothing, kStone, kTree };
  Kind kind = Kind::kNothing;
  query::NearModel model;  // of a stone or tree
};

// What happened in a step, for sounds, particles and messages.
struct Happening {
  enum class Kind : std::uint8_t {
    kFound,
    kGathered,
    kChopped,
    kFelled,
    kBuilt,
    kLit,
    kSlept,
    kRefused,
    kStepped,
    kLanded,
    kSplashed
  };
  Kind kind = Kind::kStepped;
  std::size_t number = 0;  // of the cairn that was found
  const char* why = "";    // of kRefused
  core::WorldPosition at = {};
  std::optional<world::Placement> tree = {};  // that was felled
};

// What a save keeps of a game, beside the edits.
struct Progress {
  core::WorldPosition feet;
  double yaw = 0, time_s = 0;
  std::bitset<kCairns> found;
  Stock stock;
  bool lantern = false;
  std::vector<Fire> fires;
  std::vector<core::WorldPosition> waymarks;  // that the player has built
  // Cells of the map, by cell_name(), with what is there: a world::GroundKind, or kMapWater.
  std::unordered_map<std::uint64_t, std::uint8_t> seen;
};

inline constexpr int kStonesOfCairn = 5, kWoodOfFire = 2;
inline constexpr double kMapCellM = 24;
inline constexpr std::uint8_t kMapWater = world::kGroundKinds;

class Play {
 public:
  // A new game in a land, whose seed the world has. `registry` outlives it, and has add_types().
  // Fails as find_route() and world::Edits::place().
  static core::Result<std::unique_ptr<Play>> create(const world::World& world,
                                                    const models::Registry& registry);

  // One step of `dt` seconds, always the same.
  void step(const Intent& intent, double dt);
  // What happened since this was last called.
  std::vector<Happening> take_happenings() { return std::exchange(happenings_, {}); }

  // Goes on from a save. Fails as physics::World::set_feet(); the game is as it was then.
  core::Result<void> resume(Progress progress, world::Edits edits);

  const Progress& progress() const { return progress_; }
  const world::Edits& edits() const { return edits_; }
  const Route& route() const { return route_; }
  const Walker& walker() const { return *walker_; }
  const Creatures& creatures() const { return creatures_; }
  const Target& target() const { return target_; }
  double felling() const { return felling_; }  // of the tree that is felled: 0 … 1
  Weather weather() const { return weather_at(world_.seed, progress_.time_s); }
  double hour() const;  // of the day
  bool is_night() const { return hour() < 5.5 || hour() > 19.5; }
  // What the player has: an ability for each found cairn.
  Abilities abilities() const { return Abilities((1ULL << progress_.found.count()) - 1); }
  // The next cairn, or nothing when all are found.
  std::optional<std::size_t> next_cairn() const;
  bool is_finished() const { return progress_.found.all(); }
  int most_stones() const { return has(abilities(), Ability::kSatchel) ? 40 : 12; }
  // The nearest fire that burns within reach, or null.
  const Fire* fire_near(double reach_m) const;

  query::World& query() { return query_; }
  const world::World& world() const { return world_; }
  const models::Registry& registry() const { return *registry_; }
  double block_m() const { return world_.block_size_m(); }

 private:
  Play(const world::World& world, const models::Registry& registry);
  core::Result<void> begin();
  core::Result<void> place_cairn(const core::WorldPosition& at, int stones, double width_m);
  void take_edits(world::Edits edits);
  void look_for_target();
  void act(const Intent& intent, double dt);
  void gather();
  void fell(double dt);
  void build();
  void light_fire();
  void sleep();
  void find_cairns();
  void see_around();
  void see(std::int32_t x, std::int32_t z);
  void tell_of_walker();
  void refuse(const char* why);
  std::optional<core::WorldPosition> dry_place_ahead();

  world::World world_;
  const models::Registry* registry_;
  query::World query_;
  std::optional<physics::World> physics_;
  std::optional<Walker> walker_;
  Creatures creatures_;
  Route route_;
  world::Edits edits_;
  Progress progress_;
  Target target_;
  double felling_ = 0;
  std::uint64_t steps_ = 0;
  std::vector<Happening> happenings_;
};

}  // namespace cairns
