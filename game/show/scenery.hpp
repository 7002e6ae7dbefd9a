// The game's entities in the scene: creatures, smoke and light of cairns, fires, rain, falling
// trees and the lantern. They follow the game and never change it. Main thread only.
#pragma once

#include <array>
#include <unordered_map>
#include <vector>

#include "ecs/ecs.hpp"
#include "engine/app/session.hpp"
#include "engine/core/mesh_data.hpp"
#include "engine/scene/objects/components.hpp"
#include "engine/scene/scene.hpp"
#include "game/play/play.hpp"

namespace cairns {

// A deer, bird or fish is a body and up to two parts that swing against each other, made of a few
// ellipsoids and fins. Units are metres; the animals face −Z.
inline constexpr std::size_t kParts = 3;
struct Part {
  core::MeshData mesh;
  glm::vec3 joint{0.0F};  // pivot, relative to the creature's base point
  glm::vec3 axis{1, 0, 0};
  float swing = 0;  // amplitude in radians
};

class Scenery {
 public:
  // Creates the meshes and entities in a session. Call once. Fails like scene::Assets::add_mesh().
  core::Result<void> open(app::Session& session);
  // Call before a tick. Interpolates all entities between the last two steps; `share` is 0 to 1.
  // Sets the weather and the hour of the day in the sky, because the sky's own clock also runs
  // while the game is paused.
  void update(app::Session& session, const Play& play, double share, double hour);
  // Presents an event of the game.
  void tell(app::Session& session, const Happening& happening, const Play& play);
  // Removes all entities of a game, before another game or the title screen.
  void clear(app::Session& session);

 private:
  // The parts of a creature; or the fire, smoke and light of a fire.
  struct Shown {
    std::array<ecs::Entity, kParts> parts;
    std::uint64_t frame = 0;  // the last one with it
  };
  using ShownByKey = std::unordered_map<std::uint64_t, Shown>;
  struct Falling {
    ecs::Entity entity;
    scene::MeshId mesh;
    double yaw = 0, since_s = 0;
  };
  void update_creatures(scene::Scene& scene, const Play& play, double share);
  void update_fires(scene::Scene& scene, const Play& play);
  void update_beacon(scene::Scene& scene, const Play& play);
  void update_weather(app::Session& session, const Play& play, double hour);
  void update_falling(scene::Scene& scene, const Play& play);
  void remove_gone(ShownByKey& shown, ecs::World& world) const;
  static void take_away(const Falling& tree, scene::Scene& scene);

  std::array<std::array<Part, kParts>, kKinds> shapes_;
  std::array<std::array<scene::MeshId, kParts>, kKinds> meshes_;
  ShownByKey creatures_;  // key: Creature::seed
  ShownByKey fires_;      // key: position of the fire
  std::vector<Falling> falling_;
  ecs::Entity smoke_, glow_, beacon_light_, rain_, snow_, lantern_;
  world::Sky clear_sky_;  // of the world file
  std::uint64_t frame_ = 0;
};

}  // namespace cairns
