// All values of a scene. Private to engine/scene and its tests: only here and in the sources beside
// it do all rooms meet. Systems get only the values that they name (tick.cpp). Main thread only.
#pragma once

#include <memory>
#include <string>
#include <unordered_set>
#include <vector>

#include "engine/core/geometry_memory.hpp"
#include "engine/scene/draws/shown_nodes.hpp"
#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/scene/frame/input.hpp"
#include "engine/scene/frame/output.hpp"
#include "engine/scene/meshes/scene_meshes.hpp"
#include "engine/scene/nodes/edits.hpp"
#include "engine/scene/objects/assets.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/telemetry_system.hpp"
#include "engine/telemetry/marks.hpp"
#include "engine/telemetry/own_figures.hpp"

namespace psygen::scene {

struct State {
  SceneSettings settings;
  Rules rules;
  WorldFacts facts;
  ecs::World entities;
  Events events;
  Simulation simulation{entities};
  FixedStep step;
  ecs::Schedule tick{entities};  // filled by build_tick
  // The names of the systems that build_tick added, and the types of the values that they use.
  std::unordered_set<std::string> engine_systems;
  std::unordered_set<const void*> engine_values;
  Input input;
  Clock clock;
  Camera camera;
  MemoryPressure pressure;
  Quality quality;
  Daylight daylight;
  PendingEdits pending_edits;
  Streaming streaming;
  GroundPatches patches;
  View view;
  std::unique_ptr<core::GeometryMemory> heap;  // the null device's memory; unused with a renderer
  core::GeometryMemory* memory = nullptr;
  Output output;
  synthesis::MeshSupply supply;
  SceneMeshes meshes;
  DrawLists draws;
  Assets assets;
  ObjectDraws object_draws;
  LightDraws light_draws;
  ParticleDraws particle_draws;
  ShownNodes shown;
  Tracing trace;
  Telemetry telemetry;
  telemetry::OwnFigures figures;  // of the game
  telemetry::Marks marks;
  // Of the last tick, in the order of system_names(): times, and work if it is counted; else empty.
  std::vector<float> system_ms;
  std::vector<std::uint64_t> system_work;
  bool counts_work = false;
  synthesis::CalibrationReport calibration;
  // Types of earlier worlds that objects or hung modelers still use.
  std::vector<models::Registry> retired_types;

  // Bundles, for calls outside the schedule.
  FrameContext frame() const { return {settings, rules, clock}; }
  StreamingContext streaming_context() const { return {frame(), camera, quality, facts, daylight}; }
  RenderContext render_context() const {
    return {frame(), input, camera, quality, facts, streaming, view};
  }
  NodeWork node_work() { return {entities, supply, events.created, events.removed}; }
  CacheWork cache_work() {
    return {supply, meshes, patches, pressure, events.evicted, events.places_ready};
  }
  UploadWork upload_work() { return {supply, meshes, patches, output, events.ready}; }
};

// The values behind a scene.
State& state_of(Scene& scene);
const State& state_of(const Scene& scene);

// The bytes that a mesh takes of the budget.
std::uint64_t bytes_of(const synthesis::MeshKey& key, const models::Parameters& parameters,
                       const State& state);

// Sets all counts of a tick to 0.
void reset_counts(State& state);

// Provides the values of `state` to its schedule and adds the systems in their order. Once per
// state.
void build_tick(State& state);

// The names of the systems: those of the tick in their order, then those of the simulation, as
// "step <name>".
std::vector<std::string> system_names(const State& state);

// Runs all systems once and measures each (State::system_ms, system_work). No engine system fails:
// work that cannot be done is counted and left for the next tick. Output::error tells what ended
// the flight, if anything; also that a game's system threw.
void tick(State& state);

}  // namespace psygen::scene
