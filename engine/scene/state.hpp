// Everything that one tick reads and writes, split by who touches it. `State` owns it all; the
// systems get only the parts they name (tick.cpp). Main thread only.
#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "ecs/ecs.hpp"
#include "engine/core/camera.hpp"
#include "engine/models/registry.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/block_grid.hpp"
#include "engine/scene/components.hpp"
#include "engine/scene/settings.hpp"
#include "engine/synthesis/cost_model.hpp"
#include "engine/synthesis/geometry_cache.hpp"
#include "engine/synthesis/planner.hpp"
#include "engine/synthesis/synthesis_manager.hpp"
#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/trace_log.hpp"
#include "engine/visibility/camera_predictor.hpp"
#include "engine/visibility/frustum.hpp"
#include "engine/visibility/plp.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/world.hpp"

namespace psygen::scene {

// What the outside asks for in the next tick.
struct Input {
  core::CameraPose pose;
  core::Extent size{1280, 720};
  std::vector<std::string> overlay_lines;
  render::View view = render::View::kNormal;
};

struct Clock {
  double now_s = 0;     // of the flight: real, or frame / rate with a fixed step
  double origin_s = 0;  // core::monotonic_seconds() when the scene was made
  double real_s = 0;    // real seconds since then, for latencies; set by the tick
  std::uint32_t tick = 1;
};

struct Camera {
  core::CameraPose pose;  // the last valid one
  core::Projection projection;
  core::Extent size;
  float pixels_per_radian = 0;
  std::uint64_t rejected_poses = 0;
  visibility::CameraPredictor predictor;
  struct Prediction {
    float tau_s = 0;
    core::CameraPose pose;
  };
  std::vector<Prediction> predictions;
};

// The unchanging world and what is derived from it once.
struct WorldFacts {
  world::World world;
  models::Registry registry;
  render::Light light;
  render::TerrainPalette palette;
  std::uint32_t models_per_block = 0;
  float cell_m = 1;
  glm::vec2 models_reach_m{0.0F};  // from their foot: sideways, up
};

struct Streaming {
  BlockGrid grid;
  std::vector<core::BlockCoord> missing;  // nearest last
  bool centred = false;
};

// The visibility of this tick. Cells are those of the window, row by row.
struct View {
  visibility::PlpResult plp;
  visibility::Frustum frustum;
  std::vector<core::Bounds> bounds;  // per cell, relative to the camera
  std::vector<float> deadlines;  // per cell, seconds until it is expected in view; +inf: it is not
  std::vector<ecs::Entity> visible;   // blocks in view, most important first
  std::vector<ecs::Entity> expected;  // blocks expected in view, soonest first
  std::vector<ecs::Entity> around;    // the others, nearest layers first
};

struct Synthesis {
  std::unique_ptr<synthesis::GeometryCache> cache;
  std::unique_ptr<synthesis::CostModel> cost;
  std::unique_ptr<synthesis::SynthesisManager> manager;
  std::unique_ptr<synthesis::Planner> planner;
  std::vector<synthesis::Want> wants;
  std::vector<synthesis::Completion> finished;  // synthesised, not yet resident; oldest first
  struct Ready {
    ecs::Entity entity;
    synthesis::MeshHandle handle;
  };
  std::vector<Ready> ready;  // found in the cache in this tick
  bool settling = false;     // levels follow from the pose alone: not from what came first, or when
  float coarsening = 1;      // ≥ 1: how much the wanted error grows under memory pressure
};

struct DrawLists {
  std::vector<render::TerrainDraw> terrain;
  std::vector<render::MeshDraw> models;
};

// Counts of one tick, reset by the tick.
struct Counters {
  std::uint32_t blocks_created = 0, blocks_destroyed = 0;
  std::uint32_t nodes_in_view = 0;
  std::uint32_t holes = 0;   // nodes in view that are drawn at no level
  std::uint32_t coarse = 0;  // nodes in view coarser than wanted by more than one level
  double missing_pixels_percent = 0;
  std::uint32_t requests = 0;  // wanted, but not there
  std::uint32_t refused = 0;   // of these, for want of memory
  std::uint32_t completed = 0, failed = 0;
  std::uint32_t models_synthesised = 0;
  std::uint64_t triangles_synthesised = 0, bytes_synthesised = 0;
  double synthesis_seconds = 0;
  std::vector<float> time_to_visible_ms;  // of mesh entities that came into view and are drawn
  struct Cost {
    double predicted_s, actual_s;
  };
  std::vector<Cost> costs;
  render::FrameResult frame;
};

// What is remembered from tick to tick for the sake of counting.
struct Totals {
  std::uint64_t failed = 0;
  bool warned_budget = false;
  synthesis::CacheStats cache;  // at the end of the last tick
};

// (model type, list) → the renderer's name of a shared index list.
using SharedIndices = std::unordered_map<std::uint64_t, std::uint32_t>;

// Where a frame goes, and what ended the flight early, if anything.
struct Output {
  render::Renderer* renderer = nullptr;  // null: everything but drawing
  SharedIndices shared_indices;
  std::optional<core::Error> error;
};

// The trace of a run with its names looked up once; `log` may be null.
struct Tracing {
  telemetry::TraceLog* log = nullptr;
  telemetry::TraceLog::Track main = 0, cache_bytes = 0, requests = 0;
  std::vector<telemetry::TraceLog::Name> systems;    // in the order of the tick
  std::vector<telemetry::TraceLog::Track> modelers;  // by number
  std::vector<telemetry::TraceLog::Name> models;     // by index in the registry
};

struct State {
  Settings settings;
  WorldFacts facts;
  ecs::World entities;
  ecs::Schedule tick{entities};  // filled by build_tick
  Input input;
  Clock clock;
  Camera camera;
  Streaming streaming;
  View view;
  std::unique_ptr<core::GeometryMemory> heap;  // the null device's memory; unused with a renderer
  core::GeometryMemory* memory = nullptr;
  Output output;
  Synthesis synthesis;
  DrawLists draws;
  Counters counters;
  Totals totals;
  Tracing trace;
  telemetry::FrameRecord record;  // of the last tick; the main loop adds frame_ms
};

}  // namespace psygen::scene
