// A game of Cairns without rendering, sound or keys: the land, the player, and the progress. It
// owns a copy of the world with the player's edits, and its own queries and physics. Its state
// therefore depends only on the seed and the intents of its steps: bit for bit the same in the same
// build, at every frame rate, with or without a renderer. Single-threaded.
#pragma once

#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "engine/physics/world.hpp"
#include "engine/query/world.hpp"
#include "engine/world/edits/edits.hpp"
#include "game/play/creatures.hpp"
#include "game/play/land.hpp"
#include "game/play/route.hpp"
#include "game/play/walker.hpp"

namespace cairns {

// Items that the player carries.
struct Stock {
  int stones = 0, wood = 0;
};

// A burning fire. `until_s` is a time of the game in seconds.
struct Fire {
  core::WorldPosition at;
  double until_s = 0;
};

// The object that the player can use.
struct Target {
  enum class Kind : std::uint8_t { kNothing, kStone, kTree };
  Kind kind = Kind::kNothing;
  query::NearbyModel model;  // the stone or tree
};

// An event of a step, for sounds, particles and messages.
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
  std::size_t number = 0;  // kFound: index of the cairn
  const char* why = "";    // kRefused: the reason
  core::WorldPosition at = {};
  std::optional<world::Placement> tree = {};  // kFelled: the tree
};

// The saved state of a game, apart from its edits.
struct Progress {
  core::WorldPosition feet;
  double yaw = 0, time_s = 0;
  std::bitset<kCairns> found;
  Stock stock;
  bool lantern = false;
  std::vector<Fire> fires;
  std::vector<core::WorldPosition> waymarks;  // cairns built by the player
  // Explored cells of the map, by cell_name(): a world::GroundKind, or kMapWater.
  std::unordered_map<std::uint64_t, std::uint8_t> seen;
};

inline constexpr int kStonesOfCairn = 5, kWoodOfFire = 2;
inline constexpr double kMapCellM = 24;
inline constexpr std::uint8_t kMapWater = world::kGroundKinds;

class Play {
 public:
  // Starts a new game in a world. `registry` must outlive the game and contain the types of
  // add_types(). Fails like find_route() and world::Edits::place().
  static core::Result<std::unique_ptr<Play>> create(const world::World& world,
                                                    const models::Registry& registry);

  // Advances the game by one fixed step of `dt` seconds.
  void step(const Intent& intent, double dt);
  // Returns the events since the last call.
  std::vector<Happening> take_happenings() { return std::exchange(happenings_, {}); }

  // Resumes from a save. In a land that has changed since, the hidden cairns move to their new
  // places, and ground lifts a player whom it would bury. Fails like physics::World::set_feet() and
  // world::Edits::place(), and then changes nothing.
  core::Result<void> resume(Progress progress, world::Edits edits);

  const Progress& progress() const { return progress_; }
  const world::Edits& edits() const { return edits_; }
  const Route& route() const { return route_; }
  const Walker& walker() const { return *walker_; }
  const Creatures& creatures() const { return creatures_; }
  const Target& target() const { return target_; }
  double felling() const { return felling_; }  // progress on the current tree, 0 to 1
  Weather weather() const { return weather_at(world_.seed, progress_.time_s); }
  double hour() const;  // of the day
  bool is_night() const { return hour() < 5.5 || hour() > 19.5; }
  // Returns the player's abilities: one for each cairn found.
  Abilities abilities() const { return Abilities((1ULL << progress_.found.count()) - 1); }
  // Returns the next cairn, or nullopt if all are found.
  std::optional<std::size_t> next_cairn() const;
  bool is_finished() const { return progress_.found.all(); }
  int max_stones() const { return has(abilities(), Ability::kSatchel) ? 40 : 12; }
  // Returns the nearest burning fire within reach, or null.
  const Fire* fire_near(double reach_m) const;

  query::World& query() { return query_; }
  const world::World& world() const { return world_; }
  const models::Registry& registry() const { return *registry_; }
  double block_m() const { return world_.block_size_m(); }

 private:
  Play(const world::World& world, const models::Registry& registry);
  core::Result<void> begin();
  core::Result<void> stand_cairns();
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
  void refuse(const char* why);
  void happen(Happening::Kind kind, const core::WorldPosition& at) {
    happenings_.push_back({.kind = kind, .at = at});
  }
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
