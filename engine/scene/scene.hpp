// A scene: one world, its entities, its modelers and its cache, ready to tick. Owns the State; the
// tick itself is in tick.cpp. Works without a renderer (a null device): then nothing is drawn.
// Main thread only; the modelers are threads of its own.
#pragma once

#include <functional>
#include <memory>
#include <unordered_map>
#include <vector>

#include "engine/scene/state.hpp"
#include "engine/scene/tick.hpp"

namespace psygen::scene {

// Told how far something long has come: a label and a fraction in [0, 1]; often enough for a window
// to stay alive. False ends filling the cache early; creating a scene is not ended.
using Progress = std::function<bool(std::string_view, double)>;

// What code of a game adds to: components and entities of its own, systems that run once a frame
// among the engine's (docs/architecture.md lists their names), and systems that run once a fixed
// step. Systems of a frame may take any part of State, systems of a step WorldFacts and FixedStep;
// both take queues of events and what resource() made.
struct Systems {
  ecs::World& entities;
  ecs::Schedule& frame;
  ecs::Schedule& step;

  // A resource for both kinds of systems. It lives as long as the scene.
  template <class R, class... Args>
  R& resource(Args&&... args) {
    R& made = frame.emplace<R>(std::forward<Args>(args)...);
    step.provide(made);
    return made;
  }
};

// What prepare_world() has to know of a scene. A copy, for another thread.
struct SceneSnapshot {
  Settings settings;
  world::World world;                      // without edits
  std::vector<core::BlockCoord> blocks;    // whose models exist
  std::shared_ptr<const Derived> derived;  // of the world; null: nothing can be taken over
};

// A world that is ready to take the place of a scene's.
struct PreparedWorld {
  WorldFacts facts;  // without pictures of trees in the renderer
  // Only sky, water, palette or name differ, and of `facts` there is nothing else.
  bool looks_only = false;
  // What stands on the blocks of the snapshot, but for the scatters that are the same as in the
  // world of `before`; null: there are none.
  std::unordered_map<core::BlockCoord, std::vector<world::Placement>, core::BlockCoordHash> models;
  std::shared_ptr<const Derived> before;
};

// Does what takes time of taking over another world (Scene::set_world). Any thread. Fails as
// Scene::create(). Some 10 ms, and 0.2 ms for each block; less where only some scatters differ.
core::Result<PreparedWorld> prepare_world(world::World world, models::Registry registry,
                                          const SceneSnapshot& snapshot);

// One world with its entities, its meshes and its tick.
class Scene {
 public:
  // `world` may have edits. `renderer`, `trace` and `remote` (further modelers, not with virtual
  // time) may be null and outlive the scene.
  // Starts the modelers and calibrates the cost model (below 0.5 s). Fails as check(), and with
  // kOverBudget for a view with more than kMaxEntities nodes and models or kMaxPlaces places for
  // nodes.
  static core::Result<std::unique_ptr<Scene>> create(world::World world, models::Registry registry,
                                                     const Settings& settings,
                                                     render::Renderer* renderer,
                                                     telemetry::TraceLog* trace = nullptr,
                                                     const Progress& progress = {},
                                                     synthesis::RemoteModelers* remote = nullptr);

  // All that the tick reads and writes.
  State& state() { return state_; }
  const State& state() const { return state_; }
  const synthesis::CalibrationReport& calibration() const { return calibration_; }

  // What code of a game adds to, before the first tick.
  Systems systems() { return {state_.entities, state_.tick, state_.simulation.systems}; }
  // Puts all systems into the order of their places. Fails with kInvalidArgument for two systems of
  // one name, and for systems that name others that there are not, or wait for each other.
  core::Result<void> arrange();

  // Fills the cache for a pose before the first frame (paper, section 4: the initial cache): ticks
  // without drawing and waits for the modelers, until nothing is missing, or nothing more can be
  // had (a small budget, models that fail); with a target of frame times at the error of the
  // start. Also what makes a picture independent of timing.
  // Returns how many meshes were synthesised.
  std::uint64_t settle(const core::CameraPose& pose, const Progress& progress = {});

  // Data amplification (section 3.3.1): synthesises all models around the pose at every level that
  // a flight can want, once and for all. Fails with kOverBudget, saying how much it would need.
  core::Result<std::uint64_t> amplify(const core::CameraPose& pose, const Progress& progress = {});

  // The edits of the world: all that were asked for, though some may be drawn only in a few ticks.
  // A copy is O(1), and editing a copy changes nothing here.
  const world::Edits& edits() const { return state_.editing.edits; }
  // Replaces them, from the next tick on. `edits` must be made for this world and registry. What is
  // drawn stays until the new meshes are there. An edit taken back restores the very same meshes.
  void edit(world::Edits edits);

  // Replaces the world and its types, from the next tick on: for editors, and for games whose world
  // changes. Meshes that are the same stay, others are drawn until the new ones are there; where
  // blocks have another size or other levels, everything is made anew. The edits are kept. Waits
  // for requests that modelers work on. Queries of the old world (query::World) end. After
  // kDeviceLost the scene is lost, after other errors nothing has changed.
  core::Result<void> set_world(PreparedWorld prepared);
  // The same with all that takes time.
  core::Result<void> set_world(world::World world, models::Registry registry);
  // What prepare_world() needs.
  SceneSnapshot snapshot() const;

  // Replaces the sky from the next tick on: weather, and the hour. O(1); may be called every frame.
  // The ground's shadows follow a sun that has moved. Fails with kInvalidArgument for numbers that
  // are not finite, and for visibility_m, haze_height_m or exposure not above 0.
  core::Result<void> set_sky(const world::Sky& sky);

  // Fails with kInvalidArgument for settings that make no sense, and with kOverBudget for a budget
  // below kMinBudgetBytes or above kMaxBudgetBytes.
  static core::Result<void> check(const Settings& settings);

  // To be called after Renderer::set_preset(): with shadows what is out of the picture matters too,
  // and near trees may be coarser where textures hide it.
  void take_over_preset();

  static constexpr std::uint64_t kMinBudgetBytes = 4ull << 20;
  static constexpr std::uint64_t kMaxBudgetBytes = 1ull << 40;
  static constexpr double kMaxEntities = 2e6;
  static constexpr double kMaxPlaces = 4e6;  // of nodes around the camera that may exist

 private:
  Scene() = default;
  core::Result<void> check_region() const;
  void tick_without_drawing(const core::CameraPose& pose, const std::function<bool()>& go_on);

  State state_;
  synthesis::CalibrationReport calibration_;
  // Types of worlds before, that objects or modelers that hang still use.
  std::vector<models::Registry> retired_types_;
};

}  // namespace psygen::scene
