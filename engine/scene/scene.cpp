#include "engine/scene/scene.hpp"

#include <fmt/format.h>

#include <utility>

#include "engine/core/clock.hpp"
#include "engine/core/heap_geometry_memory.hpp"
#include "engine/core/log.hpp"
#include "engine/scene/cost_samples.hpp"
#include "engine/scene/mesh_notes.hpp"
#include "engine/scene/nodes/usual_boxes.hpp"
#include "engine/scene/systems.hpp"
#include "engine/scene/tree_pictures.hpp"
#include "engine/scene/world_facts.hpp"

namespace psygen::scene {
namespace {

// Takes over how many modelers started. Fails if there are none: no mesh would ever be made.
core::Result<void> start_modelers(const synthesis::SynthesisOptions& options,
                                  synthesis::MeshSupply& meshes, Settings& settings) {
  const unsigned wanted =
      settings.virtual_time ? 1 : synthesis::modeler_count_for(settings.modelers);
  settings.modelers = meshes.start_modelers(options);
  if (settings.modelers == 0) {
    return core::fail(core::ErrorCode::kInternal,
                      fmt::format("no modeler can be started: {}", meshes.shortage()));
  }
  if (settings.modelers < wanted) {
    core::log_warning(fmt::format("only {} of {} modelers can be started: {}", settings.modelers,
                                  wanted, meshes.shortage()));
  }
  return {};
}

Tracing tracing_of(telemetry::TraceLog* log, std::uint32_t modelers,
                   const models::Registry& registry) {
  Tracing tracing;
  if (log == nullptr) return tracing;
  tracing.log = log;
  tracing.main = log->add_track("main thread");
  tracing.cache_bytes = log->add_counter("cache bytes");
  tracing.requests = log->add_counter("requests");
  tracing.gpu_ms = log->add_counter("device ms");
  tracing.device_wait = log->intern("wait for the device");
  tracing.acquire = log->intern("wait for the window");
  tracing.present = log->intern("present");
  for (std::uint32_t i = 0; i < modelers; ++i) {
    tracing.modelers.push_back(log->add_track(fmt::format("modeler {}", i)));
  }
  for (models::ModelIndex i = 0; i < registry.size(); ++i) {
    tracing.models.push_back(log->intern(registry[i].name()));
  }
  return tracing;
}

// Devices of their own mostly need no relief; others get what acts at once and changes no shape.
double start_relief(const render::Renderer* renderer, double pixel_relief) {
  return renderer != nullptr && !renderer->device().software ? 1 : pixel_relief;
}

}  // namespace

core::Result<void> Scene::arrange() {
  for (ecs::Schedule* schedule : {&state_.tick, &state_.simulation.systems}) {
    if (std::string error = schedule->arrange(); !error.empty())
      return core::fail(core::ErrorCode::kInvalidArgument, std::move(error));
  }
  return {};
}

core::Result<void> Scene::check(const Settings& settings) {
  const auto refuse = [](std::string sentence) {
    return core::fail(core::ErrorCode::kInvalidArgument, std::move(sentence));
  };
  if (!(settings.view_distance_m >= 32 && settings.view_distance_m <= 65536)) {
    return refuse("view distance must be between 32 and 65536 m");
  }
  if (!(settings.max_error_pixels > 0 && settings.max_error_pixels <= 1000)) {
    return refuse("the error of levels of detail must be above 0 and at most 1000 pixels");
  }
  if (!(settings.target_frame_ms >= 0 && settings.target_frame_ms <= 10'000)) {
    return refuse("the target of the frame time must be between 0 and 10000 ms");
  }
  if (!(settings.min_resolution >= double{render::kMinResolution} &&
        settings.min_resolution <= 1)) {
    return refuse("the resolution of the landscape may fall to a share between 0.25 and 1");
  }
  if (!(settings.max_error_factor >= 1 && settings.max_error_factor <= 100)) {
    return refuse("the error may grow by a factor between 1 and 100");
  }
  if (!(settings.fade_seconds >= 0 && settings.fade_seconds <= 60)) {
    return refuse("models come and go within 0 to 60 seconds");
  }
  if (!(settings.step_hz >= 1 && settings.step_hz <= 10'000)) {
    return refuse("the simulation must have between 1 and 10000 steps a second");
  }
  if (settings.streaming_ticks < 1) return refuse("nodes are created over at least one tick");
  if (settings.modelers > 256) return refuse("there may be at most 256 modelers");
  if (settings.budget_bytes < kMinBudgetBytes || settings.budget_bytes > kMaxBudgetBytes) {
    return core::fail(core::ErrorCode::kOverBudget,
                      fmt::format("a budget of {} bytes is not allowed: it must be {} to {} bytes",
                                  settings.budget_bytes, kMinBudgetBytes, kMaxBudgetBytes));
  }
  return {};
}

void Scene::edit(world::Edits edits) {
  state_.editing = {std::move(edits), true};
}

void Scene::take_over_preset() {
  const render::Renderer* const renderer = state_.output.renderer;
  state_.facts.shadows = renderer != nullptr && renderer->casts_shadows();
  const bool near_detail = renderer != nullptr && renderer->has_near_models();
  if (std::exchange(state_.facts.near_detail, near_detail) == near_detail) return;
  for (Foresight::Place& place : state_.foresight.places)
    place.stale = true;
}

core::Result<std::unique_ptr<Scene>> Scene::create(world::World world, models::Registry registry,
                                                   const Settings& settings,
                                                   render::Renderer* renderer,
                                                   telemetry::TraceLog* trace,
                                                   const Progress& progress,
                                                   synthesis::RemoteModelers* remote) {
  if (auto ok = check(settings); !ok) return tl::unexpected(ok.error());
  std::unique_ptr<Scene> scene(new Scene);
  State& s = scene->state_;
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
  if (!show_stand_ins(facts, nullptr, s.output)) {
    if (auto ok = derive(settings, false, facts); !ok) return tl::unexpected(ok.error());
  }
  if (auto ok = s.assets.open(facts.registry, renderer); !ok) return tl::unexpected(ok.error());
  facts.usual_boxes = usual_boxes(facts.registry, models_on(facts, {}));
  s.streaming.grids = node_grids(settings, facts);
  scene->take_over_preset();
  if (renderer == nullptr) {
    s.heap = std::make_unique<core::HeapGeometryMemory>(settings.budget_bytes);
  }
  s.memory = renderer != nullptr ? &renderer->geometry() : s.heap.get();
  s.meshes.open(facts.registry, *s.memory, settings.budget_bytes);
  s.meshes.set_edits(facts.world.layer());
  if (!settings.virtual_time) {
    scene->calibration_ = s.meshes.calibrate(cost_samples(facts), [&](double fraction) {
      if (progress) (void)progress("calibrating", fraction);
    });
  }
  synthesis::SynthesisOptions options;
  options.modelers = s.settings.modelers;
  options.watchdog_seconds = settings.watchdog_seconds;
  options.annotate = mesh_notes(facts);
  options.remote = remote;
  if (settings.virtual_time) options.virtual_clock = [&s] { return s.clock.real_s; };
  if (auto ok = start_modelers(options, s.meshes, s.settings); !ok)
    return tl::unexpected(ok.error());
  const double pixel_relief = pixel_relief_of(settings);
  s.quality.governor = Governor({.target_ms = settings.target_frame_ms,
                                 .max_relief = pixel_relief * settings.max_error_factor,
                                 .pixel_relief = pixel_relief,
                                 .start_relief = start_relief(renderer, pixel_relief)});
  // Places may be asked for before the first tick (readiness.hpp).
  fit_to_size(s.input.size, s.camera);
  set_detail(s.settings, s.quality);
  s.simulation.step.step_s = 1 / settings.step_hz;
  build_tick(s);
  s.trace = tracing_of(trace, s.settings.modelers, facts.registry);
  return scene;
}

}  // namespace psygen::scene
