// What a game has in the landscape beside the land: creatures, smoke and light of cairns, fires,
// rain, falling trees, the lantern. Entities of the scene that follow the game; it changes nothing
// of the game. Main thread.
#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "engine/app/session.hpp"
#include "engine/scene/scene.hpp"
#include "game/play/play.hpp"
#include "game/show/shapes.hpp"

namespace cairns {

class Scenery {
 public:
  // Makes meshes and entities in a session, once. Fails as scene::Assets::add_mesh().
  core::Result<void> open(app::Session& session);
  // Before a tick: everything to where it is `share` of a step after the step before the last.
  // The weather and `hour` of the day go to the sky, whose clock is not that of the game: it goes
  // on while a game stands still.
  void update(app::Session& session, const Play& play, double share, double hour);
  // What happened since.
  void tell(app::Session& session, const Happening& happening, const Play& play);
  // Takes away all of a game, before another one or the title.
  void clear(app::Session& session);

 private:
  struct Shown {
    std::array<ecs::Entity, kParts> parts;
    std::uint64_t frame = 0;
  };
  struct Flame {
    ecs::Entity fire, smoke, light;
    std::uint64_t frame = 0;
  };
  struct Falling {
    ecs::Entity entity;
    scene::MeshId mesh;
    double yaw = 0, since_s = 0;
  };
  void update_creatures(scene::State& state, const Play& play, double share);
  void update_fires(scene::State& state, const Play& play);
  void update_beacon(scene::State& state, const Play& play);
  void update_weather(app::Session& session, const Play& play, double hour);
  void update_falling(scene::State& state, const Play& play);
  static void take_away(const Falling& tree, scene::State& state);

  std::array<std::array<Part, kParts>, kKinds> shapes_;
  std::array<std::array<scene::MeshId, kParts>, kKinds> meshes_;
  std::unordered_map<std::uint64_t, Shown> shown_;   // by Creature::seed
  std::unordered_map<std::uint64_t, Flame> flames_;  // by place
  std::vector<Falling> falling_;
  ecs::Entity smoke_, glow_, beacon_light_, rain_, snow_, lantern_;
  world::Sky clear_sky_;  // of the world file
  std::uint64_t frame_ = 0;
};

}  // namespace cairns
