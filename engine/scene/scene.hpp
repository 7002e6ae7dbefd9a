// A scene: one world with its entities, modelers, meshes and tick. The tick itself is in tick.cpp.
// Works without a renderer (a null device): then it draws nothing. Main thread only; modelers are
// threads of the scene.
//
// This header declares most types only. Include the header of each type that you use: it is named
// beside the function that returns it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/scene/places.hpp"

namespace psygen::core {
struct CameraPose;
struct WorldPosition;
}  // namespace psygen::core
namespace psygen::ecs {
struct SystemInfo;
class World;
}  // namespace psygen::ecs
namespace psygen::models {
class Registry;
}
namespace psygen::render {
struct FrameResult;
class Renderer;
}  // namespace psygen::render
namespace psygen::synthesis {
struct CalibrationReport;
class MeshSupply;
class RemoteModelers;
}  // namespace psygen::synthesis
namespace psygen::telemetry {
struct FrameRecord;
class Marks;
class OwnFigures;
class TraceLog;
}  // namespace psygen::telemetry
namespace psygen::world {
class Edits;
struct Sky;
struct World;
}  // namespace psygen::world

namespace psygen::scene {

class Assets;
struct Camera;
struct Clock;
struct FixedStep;
struct Input;
struct PreparedWorld;
struct Quality;
struct SceneSettings;
struct SceneSnapshot;
struct State;
struct Statistics;
struct Systems;
struct WorldFacts;

// Reports the progress of long work: a label and a fraction in [0, 1], often enough for a window to
// stay responsive. Return false to stop filling the cache early.
using Progress = std::function<bool(std::string_view, double)>;

// Does the slow part of Scene::set_world() (facts/world_facts.hpp). Any thread. Fails as
// Scene::create(). Takes about 10 ms, and 0.2 ms for each block; less if only some scatters differ.
core::Result<PreparedWorld> prepare_world(world::World world, models::Registry registry,
                                          const SceneSnapshot& snapshot);

// One world with its entities, its meshes and its tick.
class Scene {
 public:
  // Starts the modelers and calibrates the cost model (SceneSettings::calibration_seconds). `world`
  // may have edits. `renderer`, `trace` and `remote` (further modelers, not with virtual time) may
  // be null and must outlive the scene. Fails as check(), and with kOverBudget for a view with too
  // many nodes and models (facts/derive.hpp).
  static core::Result<std::unique_ptr<Scene>> create(world::World world, models::Registry registry,
                                                     const SceneSettings& settings,
                                                     render::Renderer* renderer,
                                                     telemetry::TraceLog* trace = nullptr,
                                                     const Progress& progress = {},
                                                     synthesis::RemoteModelers* remote = nullptr);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  // Fails with kInvalidArgument for settings out of range, and with kOverBudget for a budget below
  // kMinBudgetBytes or above kMaxBudgetBytes.
  static core::Result<void> check(const SceneSettings& settings);
  static constexpr std::uint64_t kMinBudgetBytes = 4ull << 20;
  static constexpr std::uint64_t kMaxBudgetBytes = 1ull << 40;

  // The world, its model types, and values derived from both (facts/world_facts.hpp).
  const world::World& world() const;
  const models::Registry& registry() const;
  const WorldFacts& facts() const;

  // The entities (ecs/ecs.hpp; scene/components.hpp and scene/objects/ declare components).
  ecs::World& entities();
  const ecs::World& entities() const;
  // Meshes, textures and materials of objects (objects/assets.hpp).
  Assets& assets();

  // Requests for the next tick (frame/input.hpp).
  Input& input();
  const Input& input() const;
  // The clock (frame/clock.hpp), and the time of the next tick in seconds.
  const Clock& clock() const;
  void set_now(double now_s);
  // The camera of the last tick (frame/input.hpp), and its vertical field of view from the next
  // tick on.
  const Camera& camera() const;
  void set_field_of_view(float radians);
  // Fixed steps of the simulation (frame/clock.hpp).
  const FixedStep& step() const;

  // The settings (settings.hpp), and the allowed screen-space error from the next tick on.
  const SceneSettings& settings() const;
  void set_max_error(double pixels);
  // Resolution and errors of the last tick (frame/quality.hpp).
  const Quality& quality() const;
  // Holds the error of the settings at full resolution from now on, and switches fades off: frames
  // depend on neither time nor history.
  void stop_adapting();

  // Requests, modelers and geometry cache (engine/synthesis/mesh_supply.hpp).
  const synthesis::MeshSupply& meshes() const;
  // Waits until the modelers have finished all requests, or until `go_on`, which is called often,
  // returns false. Returns false if a modeler hangs.
  bool wait_for_modelers(const std::function<bool()>& go_on = {});
  const synthesis::CalibrationReport& calibration() const;

  // Counts of the last tick (statistics.hpp).
  Statistics statistics() const;
  // The renderer's result of the last tick (engine/render/types.hpp).
  const render::FrameResult& drawn() const;
  // The record of the last tick (engine/telemetry/frame_log.hpp).
  const telemetry::FrameRecord& record() const;
  // The game's figures (engine/telemetry/own_figures.hpp), and its marks, also a resource of all
  // systems (engine/telemetry/marks.hpp).
  telemetry::OwnFigures& figures();
  telemetry::Marks& marks();
  // Milliseconds of each system in the last tick, in the order of system_names().
  std::span<const float> system_ms() const;
  // Counts the work of each system from the next tick on (ecs::WorkCounter); null ends it. Then the
  // counts of the last tick, in the order of system_names(): none if nothing is counted.
  void count_work(std::uint64_t (*read)());
  std::span<const std::uint64_t> system_work() const;
  // The systems of the tick in their order, then those of fixed steps as "step <name>".
  std::vector<std::string> system_names() const;
  // The systems of the tick with their accesses (ecs/ecs.hpp).
  std::span<const ecs::SystemInfo> frame_systems() const;
  // True if the last frame showed meshes of a replaced world, for which newer ones are requested.
  bool shows_replaced_world() const;

  // The extension points for code of a game (systems.hpp), before the first tick.
  Systems systems();
  // Puts all systems into their order. Fails with kInvalidArgument for two systems of one name, for
  // systems that name unknown ones or wait for each other, and for systems of a game that use
  // values which are private to the engine.
  core::Result<void> arrange();

  // Runs one tick with the present input. Fails with the error that ends the flight: a lost device,
  // or an exception of a game's system.
  core::Result<void> tick();

  // Fills the cache for a pose before the first frame (paper, section 4: the initial cache): ticks
  // without drawing and waits for the modelers, until no mesh is missing, or none can be had (a
  // small budget, failing models). If there is a target frame time, it starts with the error of the
  // first frame. Makes frames independent of timing. Returns the number of synthesised meshes.
  std::uint64_t settle(const core::CameraPose& pose, const Progress& progress = {});
  // Data amplification (section 3.3.1): synthesises all models around the pose once, at every level
  // that a flight can want. Fails with kOverBudget and tells how much memory it would need.
  core::Result<std::uint64_t> amplify(const core::CameraPose& pose, const Progress& progress = {});

  // Requests that a place becomes ready and stays so, through edits, the course of the sun and
  // changes of the frame's size. Fails with kInvalidArgument for a position that is not finite and
  // for a radius outside (0, kMaxReadyRadiusM], and with kOverBudget if it needs more than half of
  // the memory for meshes, alone or together with other places.
  core::Result<PlaceId> request_place(const core::WorldPosition& at, double radius_m);
  // Returns the meshes that a place needs now, and how many of them are missing. Fails as
  // request_place() with kInvalidArgument. Places models on every block: about 20 µs a block.
  core::Result<Readiness> readiness(const core::WorldPosition& at, double radius_m) const;
  // The same of a requested place, as of the last tick. No meshes for an id that is not requested.
  Readiness readiness(PlaceId id) const;
  // Stops keeping the meshes of a place. Ignores ids that are not requested.
  void release_place(PlaceId id);

  // The edits of the world: all that were given to edit(), though some may be drawn only some ticks
  // later (engine/world/edits/edits.hpp). A copy is O(1), and editing a copy changes nothing here.
  const world::Edits& edits() const;
  // Replaces the edits from the next tick on. They are made for this world, or for one that it has
  // replaced (world::fitted()). Old meshes are drawn until the new ones are ready. An edit taken
  // back restores the same meshes.
  void edit(world::Edits edits);

  // Replaces the world and its types from the next tick on (facts/world_facts.hpp): for editors,
  // and for games whose world changes. Equal meshes stay, others are drawn until the new ones are
  // ready; worlds with another block size or other levels are built from nothing. Edits are kept,
  // with models of types that are gone left out until these return. Waits for requests that
  // modelers work on. Increases World::revision, by which queries and physics follow, and emits
  // WorldChanged. After kDeviceLost the scene is lost; after other errors nothing has changed.
  core::Result<void> set_world(PreparedWorld prepared);
  // As above, with the slow part included.
  core::Result<void> set_world(world::World world, models::Registry registry);
  // The input of prepare_world().
  SceneSnapshot snapshot() const;

  // Replaces the sky from the next tick on, for weather or the hour. O(1); may be called every
  // frame. The ground's shadows follow the sun. Fails with kInvalidArgument for numbers that are
  // not finite, and for visibility_m, haze_height_m or exposure not above 0.
  core::Result<void> set_sky(const world::Sky& sky);
  // Call it after Renderer::set_preset(): presets with shadows need models outside the frustum, and
  // presets with textures allow coarser near trees.
  void on_preset_changed();

  // Adds a span to the main thread's track of the trace, if there is one. Seconds of
  // core::monotonic_seconds().
  void trace_span(std::string_view name, double start_s, double end_s);
  // Ends the trace.
  void end_trace();

 private:
  Scene();
  friend State& state_of(Scene& scene);
  friend const State& state_of(const Scene& scene);

  std::unique_ptr<State> state_;
};

}  // namespace psygen::scene
