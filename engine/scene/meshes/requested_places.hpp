// Requested places (places.hpp): which meshes each needs, and which of these are missing. Follows
// edits, the sun and the size of the frame. Main thread only.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ecs/ecs.hpp"
#include "engine/core/error.hpp"
#include "engine/scene/nodes/streaming.hpp"
#include "engine/scene/places.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/visibility/quadtree.hpp"

namespace psygen::scene {

// A mesh that a place needs.
struct RequestedMesh {
  synthesis::MeshKey key;
  models::Parameters parameters;
  float distance_m = 0;  // from the place
};

// A requested place, with its listed nodes and meshes.
struct RequestedPlace {
  PlaceId id = 0;
  core::WorldPosition position;
  double radius_m = 0;
  std::vector<visibility::NodeCoord> nodes;  // whose ground and models it shows
  std::vector<RequestedMesh> meshes;
  std::shared_ptr<const models::EditLayer> layer;  // that the parameters of `meshes` refer to
  Daylight sun;                                    // of the light on its ground
  float pixels_per_radian = 0;                     // of the frame it is for
  std::uint64_t bytes = 0;
  Readiness readiness;
  bool told = false;   // PlaceReady was emitted
  bool stale = false;  // the meshes must be listed again, after edits or another preset
};

// All requested places of a scene.
struct RequestedPlaces {
  std::vector<RequestedPlace> places;
  PlaceId last_id = 0;

  // Null for an id that is not requested.
  const RequestedPlace* find(PlaceId id) const;
};

// Lists the nodes and meshes of a place. Fails with kInvalidArgument for a position that is not
// finite and for a radius outside (0, kMaxReadyRadiusM]. Places models on every block: about 20 µs
// a block.
core::Result<RequestedPlace> place_at(const StreamingContext& context,
                                      const core::WorldPosition& position, double radius_m);

// Finds what is missing of these meshes. `modelers`: threads that share the work.
Readiness readiness_of(std::span<const RequestedMesh> meshes, const synthesis::MeshSupply& supply,
                       std::uint32_t modelers);

// Stops keeping the meshes of a place and forgets it. Ignores ids that are not requested.
void release_place(PlaceId id, RequestedPlaces& requested, synthesis::MeshSupply& supply);

// Wants the missing meshes of all places, keeps the others, and emits which places became ready.
// Part of the cache system. O(meshes of all places); lists a place again if its nodes were edited.
void update_requested_places(const StreamingContext& context, RequestedPlaces& requested,
                             synthesis::MeshSupply& supply, ecs::EventQueue<PlaceReady>& ready);

}  // namespace psygen::scene
