// Everything that one tick reads and writes, split by who touches it. `State` owns it all; the
// systems get only the parts they name (tick.cpp). Main thread only.
#pragma once

#include <functional>
#include <glm/vec2.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "ecs/ecs.hpp"
#include "engine/core/camera.hpp"
#include "engine/models/registry.hpp"
#include "engine/models/terrain/tiles.hpp"
#include "engine/render/particles.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/components.hpp"
#include "engine/scene/draws/fading.hpp"
#include "engine/scene/events.hpp"
#include "engine/scene/nodes/grid.hpp"
#include "engine/scene/nodes/ground_relief.hpp"
#include "engine/scene/nodes/ground_sun.hpp"
#include "engine/scene/nodes/levels.hpp"
#include "engine/scene/objects/assets.hpp"
#include "engine/scene/objects/effects.hpp"
#include "engine/scene/quality/governor.hpp"
#include "engine/scene/readiness.hpp"
#include "engine/scene/settings.hpp"
#include "engine/scene/simulation.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/telemetry/frame_log.hpp"
#include "engine/telemetry/trace_log.hpp"
#include "engine/visibility/camera_predictor.hpp"
#include "engine/visibility/frustum.hpp"
#include "engine/visibility/plp.hpp"
#include "engine/visibility/solidity.hpp"
#include "engine/world/edits/edits.hpp"
#include "engine/world/placement.hpp"
#include "engine/world/world.hpp"
#include "engine/world/world_parts.hpp"

namespace psygen::world {
class FarScatters;
class PictureSet;
}  // namespace psygen::world

namespace psygen::scene {

// What the outside asks for in the next tick.
struct Input {
  core::CameraPose pose;
  core::Extent size{1280, 720};
  // Over the picture, in this order (docs/hud.md).
  render::HudDrawing hud;
  std::vector<render::TextPanel> panels;
  float text_scale = 1;             // of the panels' text
  const ImDrawData* gui = nullptr;  // valid during the tick; null: none
  render::View view = render::View::kNormal;
  // While values are tried out one after another: meshes of a world before are replaced by coarse
  // ones, and nothing gets finer, until it ends (quality/mesh_choice.hpp).
  bool draft = false;
  std::span<const render::Line> lines;  // over the picture, from the camera; valid during the tick
  // What the last frame took, without waiting for a display, and drew; 0: unknown.
  double frame_ms = 0, frame_triangles = 0;
};

// What a tick lacked. The next one's quality answers it.
struct Pressure {
  std::uint32_t refused_visible = 0;  // requests of what is seen for which there was no memory
  std::uint32_t waiting = 0;          // requests whose memory is about to be free
  std::uint32_t awaited = 0;          // Counters::awaited
  double seen_share = 0;              // of the memory for meshes, what is seen
  double at_s = 0;                    // the real clock then
};

// How fine the picture is in this tick (quality_system).
struct Quality {
  Governor governor;
  double resolution = 1;    // render::FrameInput::resolution
  double error_pixels = 0;  // that levels of detail may have
  // The same for single models. They take the square root of what the governor adds: they are near,
  // where one looks, and few of a frame's triangles.
  double model_error_pixels = 0;
  float coarsening = 1;  // >= 1: factor of both, while the geometry budget is too small
  bool draft = false;    // Input::draft
  // Real seconds since which every picture has awaited something (Counters::awaited); +inf: the
  // last one did not, or there was none.
  double awaiting_since_s = std::numeric_limits<double>::infinity();
  bool warned_budget = false;
};

// The times of this tick.
struct Clock {
  double now_s = 0;   // of the flight: real, or frame / rate with a fixed step
  double real_s = 0;  // real seconds since the scene was made, for latencies; set by the tick
  std::function<double()> read_real_s;  // where real_s comes from; in virtual time that is now_s
  std::uint32_t tick = 1;
};

// The camera of this tick and its predicted poses.
struct Camera {
  core::CameraPose pose;  // the last valid one
  core::Projection projection;
  core::Extent size;
  float pixels_per_radian = 0;
  std::uint64_t rejected_poses = 0;
  visibility::CameraPredictor predictor;
  // The pose in tau_s seconds.
  struct Prediction {
    float tau_s = 0;
    core::CameraPose pose;
  };
  std::vector<Prediction> predictions;
};

// What is derived of a world that the next one can take over where both have parts in common.
// Immutable; any thread.
struct Derived {
  world::WorldParts parts;
  std::uint64_t types = 0;                             // of the names in the registry, in order
  std::shared_ptr<const world::FarScatters> scatters;  // whose types may be gone
  std::vector<double> placed;                          // world::placed_per_block()
  std::vector<NodeLevel> levels;
  std::shared_ptr<const world::PictureSet> pictures;  // whose types may be gone; null: none
};

// The world and what is derived from it once (world_facts.hpp). Only its edits change, and how far
// models reach because of them (edits_system); everything else was derived without edits.
// Scene::set_world() replaces all of it.
struct WorldFacts {
  world::World world;
  models::Registry registry;
  std::size_t given_types = 0;  // of the registry, before the scene added its own
  render::Light light;
  render::TerrainPalette palette;
  render::Canopy canopy;                       // of forests too far to be drawn
  float cover_share = 0;                       // of the ground that they hide
  std::vector<visibility::Standing> standing;  // on a block
  std::vector<NodeLevel> levels;               // of the quadtree, finest first
  models::ModelIndex merged_model = 0;         // of meshes for all models on a node; 0: none
  std::vector<models::TerrainGrid> grids;      // of each level of the terrain type
  std::optional<models::TerrainTiles> tiles;   // of blocks' finest meshes; none without levels
  // Of each model type: where in its box, of −1 … 1 along each axis, meshes of the type usually
  // lie. Boxes hold all that parameters could lead to, which may be far more.
  std::vector<core::Bounds> usual_boxes;
  // Pictures of trees: null where there are none; the type that bakes them, with the parameters of
  // each; and of each model type the one of its quads, 0 where it has no pictures.
  std::shared_ptr<const world::PictureSet> pictures;
  models::ModelIndex picture_model = 0;
  std::vector<models::Parameters> picture_parameters;
  std::vector<models::ModelIndex> quad_models;
  std::shared_ptr<const Derived> derived;
  std::uint32_t models_per_block = 0;
  float cell_m = 1;
  glm::vec2 models_reach_m{0.0F};     // from their foot: sideways, up
  glm::vec2 scattered_reach_m{0.0F};  // the same without what was placed by hand
  bool shadows = false;  // what is drawn casts some into the picture, though it may be out of view
  bool near_detail = false;  // near models have textures: in those of trees gaps hide polygons
};

// Where the sun stands that the ground is lit by (world::set_sun).
struct Daylight {
  double azimuth_deg = 0, elevation_deg = 90;
};

// Edits that the world shall have from the next tick on.
struct Editing {
  world::Edits edits;
  bool pending = false;  // not in WorldFacts yet
};

// Which nodes exist as entities.
struct Streaming {
  std::vector<NodeGrid> grids;                        // one for each level
  std::vector<visibility::LevelDistances> distances;  // where nodes are split in this tick
  std::vector<visibility::NodeCoord> missing;         // most important last
  std::uint32_t ticks_since_listed = 0;               // the window, for what it lacks
  std::size_t per_tick = 0;                           // of what it lacked, nodes created in a tick
  std::uint32_t spread_ticks = 1;                     // over which new nodes are created now
  double listed_split_m = 0;   // of the coarsest level, when the window was last looked at
  core::BlockCoord listed_at;  // where the camera was then
};

// The nodes of one level in this tick. Cells are those of its window, row by row.
struct LevelView {
  visibility::PlpResult plp;
  std::vector<core::Bounds> bounds;  // relative to the camera
  std::vector<float> solidity;       // where PLP asks for it
  std::vector<float> deadlines;      // seconds until it is expected in view; +inf: it is not
  std::vector<std::uint8_t> part;    // that it has in the cut (visibility system); 0: none
};

// A node that matters to the picture of this tick.
struct ChosenNode {
  ecs::Entity entity;
  std::uint8_t level = 0;
  bool leaf = true;      // the level that is wanted here; else an ancestor of such
  bool fine = false;     // of the finest mesh
  bool in_view = false;  // else the sibling of one in view, without which the parent stays
  bool covered = false;  // an ancestor is drawn instead, or could be
};

// What a predicted camera sees.
struct Outlook {
  float tau_s = 0;        // when
  glm::vec3 moved{0.0F};  // from where the camera is now
  visibility::Frustum frustum;
};

// The visibility of this tick.
struct View {
  visibility::Frustum frustum;
  std::vector<Outlook> outlooks;  // soonest first
  visibility::Cut cut;            // what should be drawn
  std::vector<visibility::NodeCoord> roots;
  visibility::Horizon horizon;        // of the ground that is drawn
  std::vector<std::uint8_t> in_view;  // per node of the cut, and not behind the horizon
  std::vector<std::uint8_t> ready;    // per node of the cut: it could be drawn before this tick
  std::vector<std::uint32_t> drawn;   // of the cut: what is drawn of these
  std::vector<std::uint8_t> scratch;
  std::vector<LevelView> levels;
  std::vector<ChosenNode> chosen;     // of the cut, ancestors first, front to back
  std::vector<ecs::Entity> expected;  // nodes expected in view, soonest first
  // Nodes without which those expected could not be drawn, and ancestors of all others, which stand
  // for them where the camera turns unexpectedly; coarsest level first.
  std::vector<ecs::Entity> around;
  std::vector<ecs::Entity> kept;  // the others: they ask for nothing that they lack
};

// Meshes that the cache system found ready in this tick. The upload system gives them to their
// entities, like those that modelers made.
struct Found {
  struct Mesh {
    ecs::Entity entity;
    synthesis::MeshHandle handle;
  };
  std::vector<Mesh> meshes;
};

// What this tick draws, and its working memory.
struct DrawLists {
  std::vector<ecs::Entity> entities;  // per node of the cut; null where there is none
  std::vector<std::uint32_t> nodes;   // of the cut: what stands for it while meshes are missing
  std::vector<std::uint8_t> ready, scratch;  // per node of the cut
  std::vector<std::uint32_t> shown;          // those of `nodes`, and holes, that are in view
  std::vector<visibility::NodeCoord> shown_nodes;
  std::vector<render::TerrainDraw> terrain;
  std::vector<render::MeshDraw> models;
  std::vector<synthesis::MeshHandle> meshes;  // of both
  std::vector<render::GroundSpot> spots;      // under models near the camera
  std::vector<render::Line> lines;            // boxes of what is drawn, in the view of bounds
  NodeHandover handover;
  std::uint32_t tick = 0;  // of these lists
  double now_s = 0;        // the clock's then
  float fade_phase = 0;    // of the pattern of fades (next_phase)
};

// What is drawn of the game's objects in this tick.
struct ObjectDraws {
  std::vector<render::ObjectDraw> objects;
  std::vector<synthesis::MeshHandle> meshes;  // of objects in view
  std::uint32_t tick = 0;                     // of these lists
  double now_s = 0;                           // the clock's then
};

// The point lights of this tick.
struct LightDraws {
  std::vector<render::PointLight> lights;
  std::uint32_t tick = 0;
  double now_s = 0;  // the clock's then
};

// The emitters of this tick, back to front.
struct ParticleDraws {
  std::vector<render::ParticleDraw> emitters;
};

// The nodes that the last frame showed, in order. Empty while nobody asks.
struct ShownNode {
  ecs::Entity entity;
  visibility::NodeCoord at;
};
struct ShownNodes {
  std::vector<ShownNode> nodes;
};

// Counts of one tick, reset by the tick.
struct Counters {
  std::uint32_t nodes_created = 0, nodes_destroyed = 0;
  std::uint32_t nodes_in_view = 0;
  std::uint32_t nodes_hidden = 0;  // of the cut, behind ridges
  std::uint32_t holes = 0;         // nodes in view that are drawn at no level
  std::uint32_t coarse = 0;        // nodes in view coarser than wanted by more than one level
  // Of both, and of what has more than twice its error: what can still be synthesised.
  std::uint32_t awaited = 0;
  double missing_pixels_percent = 0;
  double seen_area = 0,
         too_coarse_area = 0;  // of pieces (draws/missing.hpp), in percent of the picture
  // Objects of the game: in view and drawn; in view without a mesh that can be drawn; with a place
  // that is none.
  std::uint32_t objects_drawn = 0, objects_missing = 0, objects_invalid = 0;
  // Point lights: those that light the picture; more in view, which had to stay dark; with values
  // or a place that are none.
  std::uint32_t lights_lit = 0, lights_left_out = 0, lights_invalid = 0;
  // Emitters of particles and their particles, the same.
  std::uint32_t emitters_drawn = 0, emitters_left_out = 0, emitters_invalid = 0;
  std::uint64_t particles_drawn = 0, particles_left_out = 0;
  std::uint32_t requests = 0;         // wanted, but not there
  std::uint32_t refused = 0;          // of these, for want of memory
  std::uint32_t refused_visible = 0;  // … of what is in view
  std::uint32_t completed = 0, failed = 0;
  std::uint32_t models_synthesised = 0;
  std::uint64_t triangles_synthesised = 0, bytes_synthesised = 0;
  double synthesis_seconds = 0;
  std::vector<float> time_to_visible_ms;  // of mesh entities that came into view and are drawn
  struct Cost {
    double predicted_s, actual_s;
    models::ModelIndex model;
  };
  std::vector<Cost> costs;
  render::FrameResult frame;
};

// What is counted from tick to tick.
struct Totals {
  std::uint64_t failed = 0;
  synthesis::CacheStats cache;  // at the end of the last tick
};

// (model type, list) → the renderer's name of a shared index list.
using SharedIndices = std::unordered_map<std::uint64_t, std::uint32_t>;

// Where a frame goes, and what ended the flight early, if anything.
struct Output {
  render::Renderer* renderer = nullptr;  // null: everything but drawing
  SharedIndices shared_indices;
  std::uint32_t pictures_lacking = 0;         // bit i: the renderer has not got picture i yet
  std::optional<std::size_t> pictures_shown;  // that the renderer has room for; of this scene
  std::optional<core::Error> error;
};

// The trace of a run with its names looked up once; `log` may be null.
struct Tracing {
  telemetry::TraceLog* log = nullptr;
  telemetry::TraceLog::Track main = 0, cache_bytes = 0, requests = 0, gpu_ms = 0;
  std::uint64_t gpu_frame = 0;                                          // the last one in gpu_ms
  std::vector<telemetry::TraceLog::Name> systems;                       // in the order of the tick
  std::vector<telemetry::TraceLog::Name> steps;                         // of the simulation
  telemetry::TraceLog::Name device_wait = 0, acquire = 0, present = 0;  // within a system
  std::vector<telemetry::TraceLog::Track> modelers;                     // by number
  std::vector<telemetry::TraceLog::Name> models;                        // by index in the registry
};

// All of a scene.
struct State {
  Settings settings;
  Rules rules;
  WorldFacts facts;
  ecs::World entities;
  Events events;
  Simulation simulation{entities};
  ecs::Schedule tick{entities};  // filled by build_tick
  Input input;
  Clock clock;
  Camera camera;
  Pressure pressure;
  Quality quality;
  Daylight daylight;
  Editing editing;
  Streaming streaming;
  View view;
  std::unique_ptr<core::GeometryMemory> heap;  // the null device's memory; unused with a renderer
  core::GeometryMemory* memory = nullptr;
  Output output;
  synthesis::MeshSupply meshes;
  Found found;
  Foresight foresight;
  DrawLists draws;
  Assets assets;
  ObjectDraws object_draws;
  LightDraws light_draws;
  ParticleDraws particle_draws;
  ShownNodes shown;
  Counters counters;
  Totals totals;
  Tracing trace;
  telemetry::FrameRecord record;  // of the last tick; the main loop adds frame_ms
  std::vector<float> system_ms;   // of the last tick, in the order of system_names()
};

}  // namespace psygen::scene
