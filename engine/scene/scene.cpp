#include "engine/scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "engine/core/clock.hpp"
#include "engine/core/geometry_memory.hpp"
#include "engine/core/log.hpp"
#include "engine/core/rounding.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/facts/derive.hpp"
#include "engine/scene/meshes/mesh_annotations.hpp"
#include "engine/scene/meshes/tree_impostors.hpp"
#include "engine/scene/state.hpp"
#include "engine/scene/systems.hpp"

namespace psygen::scene {
namespace {

// Starts the modelers and records how many started. Fails if none did: no mesh would ever be made.
core::Result<void> start_modelers(const synthesis::SynthesisOptions& options,
                                  synthesis::MeshSupply& supply, SceneSettings& settings) {
  const unsigned wanted =
      settings.virtual_time ? 1 : synthesis::modeler_count_for(settings.modelers);
  settings.modelers = supply.start_modelers(options);
  if (settings.modelers == 0) {
    return core::fail(core::ErrorCode::kInternal,
                      fmt::format("no modeler can be started: {}", supply.shortage()));
  }
  if (settings.modelers < wanted) {
    core::log_warning(fmt::format("only {} of {} modelers can be started: {}", settings.modelers,
                                  wanted, supply.shortage()));
  }
  return {};
}

// Hardware GPUs start at full resolution. Software devices start reduced: a lower resolution acts
// at once and changes no shapes.
double start_reduction(const render::Renderer* renderer, double resolution_reduction) {
  return renderer != nullptr && !renderer->device().software() ? 1 : resolution_reduction;
}

// Fails if a place, together with all requested ones, needs too much memory.
core::Result<void> check_bytes(const State& state, const RequestedPlace& place) {
  std::uint64_t all = place.bytes;
  for (const RequestedPlace& other : state.meshes.places.places)
    all += other.bytes;
  constexpr double kMiB = 1 << 20, kMaxShare = 0.5;
  const double most = kMaxShare * static_cast<double>(state.supply.stats().budget_bytes);
  if (static_cast<double>(all) <= most) return {};
  return core::fail(
      core::ErrorCode::kOverBudget,
      fmt::format("{:.0f} MiB are needed for a place of {:g} m, with all places {:.0f} MiB; half "
                  "of the budget, {:.0f} MiB, is allowed",
                  static_cast<double>(place.bytes) / kMiB, place.radius_m,
                  static_cast<double>(all) / kMiB, most / kMiB));
}

// Fails if a system of a game uses a value of the engine that is not for games (systems.hpp).
core::Result<void> check_accesses(const State& s, const ecs::SystemInfo& system) {
  constexpr std::array<std::string_view, 7> kReadable = {
      "Clock", "Camera", "Input", "View", "WorldFacts", "Quality", "FixedStep"};
  constexpr std::array<std::string_view, 7> kEvents = {"NodeShown",    "NodeHidden", "ModelCreated",
                                                       "ModelRemoved", "MeshReady",  "MeshEvicted",
                                                       "PlaceReady"};
  for (const ecs::Access& access : system.accesses) {
    if (access.is_component || !s.engine_values.contains(access.type)) continue;
    const bool readable = std::ranges::find(kReadable, access.name) != kReadable.end();
    const bool event = std::ranges::find(kEvents, access.name) != kEvents.end();
    if (event || access.name == "Input" || (readable && !access.writes)) continue;
    return core::invalid_argument(
        readable ? fmt::format("the system '{}' writes {}; systems of a game may "
                               "write Input only",
                               system.name, access.name)
                 : fmt::format("the system '{}' {} {}, which is private to the engine", system.name,
                               access.writes ? "writes" : "reads", access.name));
  }
  return {};
}

}  // namespace

std::uint64_t bytes_of(const synthesis::MeshKey& key, const models::Parameters& parameters,
                       const State& s) {
  const models::MeshSize size = s.facts.registry[key.model].mesh_size(parameters, key.level);
  return s.memory->charged_bytes(size.layout, size.vertex_count, size.own_index_count());
}

State& state_of(Scene& scene) {
  return *scene.state_;
}
const State& state_of(const Scene& scene) {
  return *scene.state_;
}

Scene::Scene() : state_(std::make_unique<State>()) {}
Scene::~Scene() = default;

const world::World& Scene::world() const {
  return state_->facts.world;
}
const models::Registry& Scene::registry() const {
  return state_->facts.registry;
}
const WorldFacts& Scene::facts() const {
  return state_->facts;
}
ecs::World& Scene::entities() {
  return state_->entities;
}
const ecs::World& Scene::entities() const {
  return state_->entities;
}
Assets& Scene::assets() {
  return state_->assets;
}
Input& Scene::input() {
  return state_->input;
}
const Input& Scene::input() const {
  return state_->input;
}
const Clock& Scene::clock() const {
  return state_->clock;
}
void Scene::set_now(double now_s) {
  state_->clock.now_s = now_s;
}
const Camera& Scene::camera() const {
  return state_->camera;
}
void Scene::set_field_of_view(float radians) {
  state_->camera.projection.vertical_fov = radians;
}
const FixedStep& Scene::step() const {
  return state_->step;
}
const SceneSettings& Scene::settings() const {
  return state_->settings;
}
void Scene::set_max_error(double pixels) {
  state_->settings.max_error_pixels = pixels;
}
const Quality& Scene::quality() const {
  return state_->quality;
}
void Scene::stop_adapting() {
  state_->settings.fade_seconds = 0;
  state_->quality.governor = Governor();
}
const synthesis::MeshSupply& Scene::meshes() const {
  return state_->supply;
}
bool Scene::wait_for_modelers(const std::function<bool()>& go_on) {
  return state_->supply.wait(go_on);
}
const synthesis::CalibrationReport& Scene::calibration() const {
  return state_->calibration;
}
Statistics Scene::statistics() const {
  const State& s = *state_;
  return {.nodes = s.streaming.counts,
          .drawn = s.draws.counts,
          .objects = s.object_draws.counts,
          .lights = s.light_draws.counts,
          .particles = s.particle_draws.counts,
          .meshes = s.meshes.counts,
          .nodes_hidden = s.view.hidden,
          .models_drawn = static_cast<std::uint32_t>(s.draws.models.size()),
          .failed_in_all = s.meshes.failed,
          .impostors_missing = s.meshes.pictures_lacking != 0};
}
const render::FrameResult& Scene::drawn() const {
  return state_->draws.frame;
}
const telemetry::FrameRecord& Scene::record() const {
  return state_->telemetry.record;
}
telemetry::OwnFigures& Scene::figures() {
  return state_->figures;
}
telemetry::Marks& Scene::marks() {
  return state_->marks;
}
std::span<const float> Scene::system_ms() const {
  return state_->system_ms;
}
void Scene::count_work(std::uint64_t (*read)()) {
  for (ecs::Schedule* schedule : {&state_->tick, &state_->simulation.systems})
    schedule->count_work(read);
  state_->counts_work = read != nullptr;
  state_->system_work.clear();
}
std::span<const std::uint64_t> Scene::system_work() const {
  return state_->system_work;
}
std::vector<std::string> Scene::system_names() const {
  return scene::system_names(*state_);
}
std::span<const ecs::SystemInfo> Scene::frame_systems() const {
  return state_->tick.systems();
}

bool Scene::shows_replaced_world() const {
  const State& s = *state_;
  const std::uint32_t tick = s.clock.tick - 1;  // the last one
  bool any = false;
  const auto look = [&](auto, auto demands) {
    any = any || std::ranges::any_of(demands, [tick](const MeshDemand& demand) {
            return demand.stale && demand.in_view_tick == tick && demand.drawn_level != kNoLevel &&
                   demand.wanted_level != kNoLevel;
          });
  };
  for (const ChosenNode& node : s.view.chosen) {
    if (node.level != 0 || !node.in_view) continue;
    s.entities.each_of<const MeshDemand>(std::span(&node.entity, 1), look);
    s.entities.each_of<const MeshDemand>(s.entities.children(node.entity), look);
  }
  return any;
}

Systems Scene::systems() {
  return {state_->entities, state_->tick, state_->simulation.systems, state_->figures};
}

core::Result<void> Scene::arrange() {
  for (ecs::Schedule* schedule : {&state_->tick, &state_->simulation.systems}) {
    if (std::string error = schedule->arrange(); !error.empty())
      return core::invalid_argument(std::move(error));
    for (const ecs::SystemInfo& system : schedule->systems()) {
      const bool own = schedule == &state_->tick && state_->engine_systems.contains(system.name);
      if (own) continue;
      if (auto ok = check_accesses(*state_, system); !ok) return ok;
    }
  }
  return {};
}

core::Result<void> Scene::tick() {
  const core::RoundToNearest rounding;
  scene::tick(*state_);
  if (state_->output.error) return tl::unexpected(*state_->output.error);
  return {};
}

core::Result<PlaceId> Scene::request_place(const core::WorldPosition& at, double radius_m) {
  State& s = *state_;
  auto place = place_at(s.streaming_context(), at, radius_m);
  if (!place) return tl::unexpected(place.error());
  for (const RequestedMesh& mesh : place->meshes)
    place->bytes += bytes_of(mesh.key, mesh.parameters, s);
  if (const auto fits = check_bytes(s, *place); !fits) return tl::unexpected(fits.error());
  RequestedPlaces& requested = s.meshes.places;
  place->id = ++requested.last_id;
  place->readiness.missing = place->readiness.meshes;
  return requested.places.emplace_back(std::move(*place)).id;
}

core::Result<Readiness> Scene::readiness(const core::WorldPosition& at, double radius_m) const {
  const auto place = place_at(state_->streaming_context(), at, radius_m);
  if (!place) return tl::unexpected(place.error());
  return readiness_of(place->meshes, state_->supply, state_->settings.modelers);
}

Readiness Scene::readiness(PlaceId id) const {
  const RequestedPlace* place = state_->meshes.places.find(id);
  return place != nullptr ? place->readiness : Readiness{};
}

void Scene::release_place(PlaceId id) {
  scene::release_place(id, state_->meshes.places, state_->supply);
}

core::Result<void> Scene::check(const SceneSettings& settings) {
  const auto within = [](double v, double low, double high) { return v >= low && v <= high; };
  if (!within(settings.view_distance_m, 32, 65536))
    return core::invalid_argument("view distance must be between 32 and 65536 m");
  if (!(settings.max_error_pixels > 0 && settings.max_error_pixels <= 1000))
    return core::invalid_argument(
        "the error of levels of detail must be above 0 and at most 1000 pixels");
  if (!within(settings.target_frame_ms, 0, 10'000))
    return core::invalid_argument("the target of the frame time must be between 0 and 10000 ms");
  if (!within(settings.min_resolution, double{render::kMinResolution}, 1))
    return core::invalid_argument("the minimum resolution must be a fraction between 0.25 and 1");
  if (!within(settings.max_error_factor, 1, 100))
    return core::invalid_argument("the maximum error factor must be between 1 and 100");
  if (!within(settings.fade_seconds, 0, 60))
    return core::invalid_argument("fades must take between 0 and 60 seconds");
  if (!within(settings.calibration_seconds, 0, 3600))
    return core::invalid_argument("calibration must take between 0 and 3600 seconds");
  if (!within(settings.step_hz, 1, 10'000))
    return core::invalid_argument("the simulation must have between 1 and 10000 steps a second");
  if (settings.streaming_ticks < 1)
    return core::invalid_argument("new nodes must be spread over at least one tick");
  if (settings.modelers > 256) return core::invalid_argument("there may be at most 256 modelers");
  if (settings.budget_bytes < kMinBudgetBytes || settings.budget_bytes > kMaxBudgetBytes) {
    return core::fail(core::ErrorCode::kOverBudget,
                      fmt::format("a budget of {} bytes is not allowed: it must be {} to {} bytes",
                                  settings.budget_bytes, kMinBudgetBytes, kMaxBudgetBytes));
  }
  return {};
}

const world::Edits& Scene::edits() const {
  return state_->pending_edits.edits;
}

void Scene::edit(world::Edits edits) {
  state_->pending_edits = {std::move(edits), true};
}

void Scene::on_preset_changed() {
  State& s = *state_;
  const render::Renderer* const renderer = s.output.renderer;
  s.facts.shadows = renderer != nullptr && renderer->casts_shadows();
  const bool near_detail = renderer != nullptr && renderer->has_near_models();
  if (std::exchange(s.facts.near_detail, near_detail) == near_detail) return;
  for (RequestedPlace& place : s.meshes.places.places)
    place.stale = true;
}

void Scene::trace_span(std::string_view name, double start_s, double end_s) {
  const Tracing& trace = state_->trace;
  if (trace.log != nullptr)
    trace.log->add_span(trace.main, trace.log->intern(name), start_s, end_s);
}

void Scene::end_trace() {
  state_->trace.log = nullptr;
}

core::Result<std::unique_ptr<Scene>> Scene::create(world::World world, models::Registry registry,
                                                   const SceneSettings& settings,
                                                   render::Renderer* renderer,
                                                   telemetry::TraceLog* trace,
                                                   const Progress& progress,
                                                   synthesis::RemoteModelers* remote) {
  if (auto ok = check(settings); !ok) return tl::unexpected(ok.error());
  std::unique_ptr<Scene> scene(new Scene);
  State& s = *scene->state_;
  s.settings = settings;
  s.clock.read_real_s = [origin_s = core::monotonic_seconds()] {
    return core::monotonic_seconds() - origin_s;
  };
  if (settings.virtual_time) s.clock.read_real_s = [&s] { return s.clock.now_s; };
  WorldFacts& facts = s.facts;
  scene->edit(world::Edits(world.edits));
  world::set_edits(world, nullptr);
  facts.world = std::move(world);
  facts.registry = std::move(registry);
  s.output.renderer = renderer;
  if (auto ok = derive(settings, true, facts); !ok) return tl::unexpected(ok.error());
  if (!show_stand_ins(facts, nullptr, s.meshes, s.output)) {
    if (auto ok = derive(settings, false, facts); !ok) return tl::unexpected(ok.error());
  }
  if (auto ok = s.assets.open(facts.registry, renderer, settings.object_budget_bytes); !ok)
    return tl::unexpected(ok.error());
  facts.typical_bounds = typical_bounds(facts.registry, models_on(facts, {}));
  s.streaming.grids = node_grids(settings, facts);
  scene->on_preset_changed();
  if (renderer == nullptr) {
    s.heap = std::make_unique<core::HeapGeometryMemory>(settings.budget_bytes);
  }
  s.memory = renderer != nullptr ? &renderer->geometry() : s.heap.get();
  s.supply.open(facts.registry, *s.memory, settings.budget_bytes);
  s.supply.set_edits(facts.world.layer());
  if (!settings.virtual_time) {
    s.calibration =
        s.supply.calibrate(cost_samples(facts), settings.calibration_seconds, [&](double fraction) {
          if (progress) (void)progress("calibrating", fraction);
        });
  }
  synthesis::SynthesisOptions options;
  options.modelers = s.settings.modelers;
  options.watchdog_seconds = settings.watchdog_seconds;
  options.annotate = mesh_annotations(facts);
  options.remote = remote;
  if (settings.virtual_time) options.virtual_clock = [&s] { return s.clock.real_s; };
  if (auto ok = start_modelers(options, s.supply, s.settings); !ok)
    return tl::unexpected(ok.error());
  const double resolution_reduction = resolution_reduction_of(settings);
  s.quality.governor =
      Governor({.target_ms = settings.target_frame_ms,
                .max_reduction = resolution_reduction * settings.max_error_factor,
                .resolution_reduction = resolution_reduction,
                .start_reduction = start_reduction(renderer, resolution_reduction)});
  // Places may be requested before the first tick (places.hpp).
  fit_to_size(s.input.size, s.camera);
  set_detail(s.settings, s.quality);
  s.step.step_s = 1 / settings.step_hz;
  build_tick(s);
  s.trace = tracing_of(trace, s.settings.modelers, facts.registry);
  return scene;
}

}  // namespace psygen::scene
