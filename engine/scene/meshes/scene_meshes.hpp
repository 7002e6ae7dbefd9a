// The meshes of a scene from demand to component, and the three systems that process them: cache
// (LODs, cache look-ups, ranks, plan), synthesis (collects finished requests) and upload (writes
// meshes into components). Main thread only.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "engine/scene/components.hpp"
#include "engine/scene/events.hpp"
#include "engine/scene/frame/output.hpp"
#include "engine/scene/frame/quality.hpp"
#include "engine/scene/meshes/requested_places.hpp"
#include "engine/scene/nodes/ground_occluder.hpp"
#include "engine/scene/nodes/ground_sunlight.hpp"
#include "engine/scene/statistics.hpp"
#include "engine/scene/view/visibility.hpp"

namespace psygen::scene {

class Assets;

// (model type, list) → the renderer's name of a shared index list.
using SharedIndices = std::unordered_map<std::uint64_t, std::uint32_t>;

struct SceneMeshes {
  struct FoundMesh {
    ecs::Entity entity;
    synthesis::MeshHandle handle;
  };
  // Meshes that the cache system found ready in this tick. The upload system writes them into their
  // entities, like those that modelers made.
  std::vector<FoundMesh> found;
  SharedIndices shared_indices;
  std::uint32_t pictures_lacking = 0;  // bit i: the renderer does not have impostor i yet
  std::optional<std::size_t>
      pictures_shown;  // impostors of this scene that the renderer has room for
  RequestedPlaces places;
  std::uint64_t failed = 0;  // requests that failed since the scene was created
  MeshCounts counts;
};

// Bundle: everything that cache_system() writes besides components.
struct CacheWork {
  synthesis::MeshSupply& supply;
  SceneMeshes& meshes;
  GroundPatches& patches;
  MemoryPressure& pressure;
  ecs::EventQueue<MeshEvicted>& evicted;
  ecs::EventQueue<PlaceReady>& places_ready;
};

// Bundle: everything that upload_system() writes besides components.
struct UploadWork {
  synthesis::MeshSupply& supply;
  SceneMeshes& meshes;
  GroundPatches& patches;
  Output& output;
  ecs::EventQueue<MeshReady>& ready;
};

// System: chooses the LODs of all mesh entities, takes from the cache the meshes that it has, ranks
// the others, and plans the synthesis of missing ones.
using CacheQuery =
    ecs::Query<const QuadtreeNode, const ecs::Children, const Visibility, const MeshPlacement,
               const LodErrors, const MeshSource, const Mesh, MeshDemand, Fading, MissingMeshes>;
void cache_system(StreamingContext context, VisibleNodes nodes, const Assets& assets,
                  CacheQuery entities, CacheWork work);

// System: collects the requests that modelers have finished since the last tick.
void synthesis_system(FrameContext frame, synthesis::MeshSupply& supply, SceneMeshes& meshes,
                      Tracing& trace);

// System: makes finished meshes resident and writes them into their entities, within the upload
// budget.
using UploadQuery =
    ecs::Query<const MeshSource, const LodErrors, Mesh, MeshParts, ReplacedParts, Fading,
               MeshDemand, QuadtreeNode, MissingMeshes, GroundOccluder, GroundSunlight>;
void upload_system(FrameContext frame, const WorldFacts& facts, UploadQuery entities,
                   UploadWork work);

}  // namespace psygen::scene
