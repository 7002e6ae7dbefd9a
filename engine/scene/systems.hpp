// The systems of the tick, one .cpp each. Free functions; const parameters and components are read,
// the others written: the schedule takes what a system touches from here. Main thread only; none of
// them waits for a modeler, a file or the GPU beyond the frames in flight (lazy evaluation waits
// for its modelers). Order and data: tick.cpp.
#pragma once

#include "engine/scene/state.hpp"

namespace psygen::scene {

// Runs the fixed steps of the simulation that are due. Their systems may change all entities.
void simulation_system(const Clock& clock, ecs::World& entities, Simulation& simulation,
                       Tracing& trace);

// Takes over the wanted pose (an invalid one is refused, the last valid one stays) and predicts
// poses.
void input_system(const Input& input, const Clock& clock, const WorldFacts& facts, Camera& camera);
// The part of it that the size of the picture decides; an empty size changes nothing.
void fit_to_size(const core::Extent& size, Camera& camera);

// Decides how fine the picture shall be, from the time that the last frames took and from what the
// last tick lacked.
void quality_system(const Settings& settings, const Rules& rules, const Input& input,
                    const Pressure& pressure, const synthesis::MeshSupply& meshes,
                    Quality& quality);
// The part of it that follows from its factors: the resolution and the errors that are allowed.
void set_detail(const Settings& settings, Quality& quality);
// How much frames are relieved of their pixels where the resolution is the least.
double pixel_relief_of(const Settings& settings);

// Moves the sun of worlds that have a day; the ground whose shadows it changes is made anew.
using DaylightQuery = ecs::Query<const Node, Source, Demand>;
void daylight_system(const Clock& clock, const WorldFacts& facts, DaylightQuery nodes,
                     Daylight& daylight);

// Takes over the edits of the world that were wanted since the last tick.
void edits_system(const Daylight& daylight, Editing& editing, WorldFacts& facts,
                  ecs::World& entities, synthesis::MeshSupply& meshes, Foresight& foresight,
                  ecs::EventQueue<ModelCreated>& created_models,
                  ecs::EventQueue<ModelRemoved>& removed_models);

// Creates and destroys nodes with their models around the camera, in batches.
void streaming_system(const Settings& settings, const Rules& rules, const Camera& camera,
                      const Quality& quality, const WorldFacts& facts, const Daylight& daylight,
                      Streaming& streaming, ecs::World& entities, synthesis::MeshSupply& meshes,
                      ecs::EventQueue<ModelCreated>& created,
                      ecs::EventQueue<ModelRemoved>& removed, Counters& counters);

// Chooses the cut through the quadtree and runs Prioritized-Layered Projection over the nodes of
// each level; what predicted cameras see gets a deadline.
using VisibilityQuery =
    ecs::Query<const Node, const Lacking, const Demand, const GroundRelief, Visibility>;
void visibility_system(const Settings& settings, const Rules& rules, const Camera& camera,
                       const WorldFacts& facts, const Streaming& streaming, VisibilityQuery nodes,
                       View& view, Counters& counters);

// Chooses levels of detail, finds what the cache has, ranks what it keeps, plans what is missing.
using CacheQuery = ecs::Query<const Node, const ecs::Children, const Visibility, const Placed,
                              const Detail, const Source, const Mesh, Demand, Fading, Lacking>;
void cache_system(const Settings& settings, const Rules& rules, const Clock& clock,
                  const Camera& camera, const Quality& quality, const WorldFacts& facts,
                  const Daylight& daylight, const Streaming& streaming, const View& view,
                  CacheQuery entities, const Assets& assets, const Output& output,
                  synthesis::MeshSupply& meshes, Found& found, Foresight& foresight,
                  Pressure& pressure, ecs::EventQueue<MeshEvicted>& evicted,
                  ecs::EventQueue<PlaceReady>& places_ready, Counters& counters);

// Collects what the modelers have finished since the last tick.
void synthesis_system(const Settings& settings, const Rules& rules, synthesis::MeshSupply& meshes,
                      Counters& counters, Tracing& trace);

// Makes finished meshes resident and lands them in their entities, within the upload budget.
using UploadQuery = ecs::Query<const Source, const Detail, Mesh, MeshParts, OldParts, Fading,
                               Demand, Node, Lacking, GroundRelief, GroundSun>;
void upload_system(const Settings& settings, const Rules& rules, const Clock& clock,
                   const WorldFacts& facts, const Found& found, UploadQuery entities,
                   synthesis::MeshSupply& meshes, Output& output,
                   ecs::EventQueue<MeshLanded>& landed, Counters& counters, Totals& totals);

// Draws the game's objects: culls them, chooses their levels of detail, fades them, and notes what
// their meshes lack.
using ObjectQuery = ecs::Query<const Transform, const GroundSun, Object>;
void objects_system(const Settings& settings, const Rules& rules, const Input& input,
                    const Clock& clock, const Camera& camera, const Quality& quality,
                    const WorldFacts& facts, const Streaming& streaming, const View& view,
                    ObjectQuery entities, synthesis::MeshSupply& meshes, Assets& assets,
                    ObjectDraws& draws, Counters& counters);

// Chooses the point lights that light the picture, and fades them in and out.
using LightQuery = ecs::Query<const Transform, PointLight>;
void lights_system(const Settings& settings, const Clock& clock, const Camera& camera,
                   const WorldFacts& facts, const View& view, LightQuery entities,
                   LightDraws& draws, Counters& counters);

// Chooses the emitters of particles that are drawn, nearest first where there are too many.
using ParticleQuery = ecs::Query<const Transform, const ParticleEmitter, const GroundSun>;
void particles_system(const Settings& settings, const Clock& clock, const Camera& camera,
                      const WorldFacts& facts, const Streaming& streaming, const View& view,
                      ParticleQuery entities, ParticleDraws& draws, Counters& counters);

// Builds the draw lists, counts what is missing, and draws (nothing is drawn without a renderer).
using RenderQuery = ecs::Query<const Node, const ecs::Children, const Visibility, const Placed,
                               const Demand, const Source, const Mesh, const MeshParts,
                               const OldParts, const GroundRelief, const GroundSun, Fading>;
void render_system(const Settings& settings, const Input& input, const Clock& clock,
                   const Camera& camera, const Quality& quality, const WorldFacts& facts,
                   const Streaming& streaming, const View& view, const ObjectDraws& objects,
                   const LightDraws& lights, const ParticleDraws& particles, RenderQuery entities,
                   synthesis::MeshSupply& meshes, DrawLists& draws, Output& output,
                   Pressure& pressure, Counters& counters);

// Tells which nodes came into the picture and which left it.
void events_system(const View& view, const DrawLists& draws, ShownNodes& shown,
                   ecs::EventQueue<NodeShown>& nodes_shown,
                   ecs::EventQueue<NodeHidden>& nodes_hidden);

// Writes down what the tick did.
void telemetry_system(const Clock& clock, const Quality& quality, const Counters& counters,
                      const synthesis::MeshSupply& meshes, Totals& totals,
                      telemetry::FrameRecord& record);

}  // namespace psygen::scene
