// Whether what can be seen around a place is there already: for spawn points and teleports. A place
// that is *asked for* is synthesised ahead of time and kept, at a lower priority than the picture,
// wherever the camera is; Foresight holds these places. To wait for one instead, fill the cache
// (Session::prepare). Main thread only.
#pragma once

#include <cstdint>
#include <vector>

#include "ecs/ecs.hpp"
#include "engine/core/error.hpp"
#include "engine/synthesis/mesh_supply.hpp"
#include "engine/visibility/quadtree.hpp"

namespace psygen::scene {

struct Camera;
struct Daylight;
struct Quality;
struct Settings;
struct State;
struct WorldFacts;

// Meshes of a place: the ground and the models up to a radius, at the levels of detail that a
// camera there would choose.
struct Readiness {
  std::uint32_t meshes = 0;
  std::uint32_t missing = 0;  // of these, not in the cache
  double expected_s = 0;      // predicted time until they are there, on all modelers; 0: they are
  bool ready() const { return missing == 0; }
};

// What a place of this radius needs now, and what of that is missing. Fails with kInvalidArgument
// for a position that is not finite and for a radius outside (0, kMaxReadyRadiusM]. Places models
// anew on every block: about 20 µs a block.
inline constexpr double kMaxReadyRadiusM = 1000;
core::Result<Readiness> readiness(const State& state, const core::WorldPosition& position,
                                  double radius_m);

// Asked-for places get ids from 1 on. PlaceReady is emitted once for each, when it is.
using PlaceId = std::uint64_t;
struct PlaceReady {
  PlaceId id = 0;
};

// Asks that a place become ready and stay so, through edits, the course of the sun and changes of
// the picture's size. Fails as readiness(), and with kOverBudget where it needs more than half of
// the memory for meshes, or together with other places.
core::Result<PlaceId> ask_ready(State& state, const core::WorldPosition& position, double radius_m);
// What is missing of it, as of the last tick. Ready with no meshes for an id that is not asked for.
Readiness readiness(const State& state, PlaceId id);
// Its meshes may go. Ids that are not asked for are ignored.
void stop_asking(State& state, PlaceId id);

// The places that are asked for.
struct Foresight {
  struct Mesh {
    synthesis::MeshKey key;
    models::Parameters parameters;
    float distance_m = 0;  // from the place
  };
  struct Place {
    PlaceId id = 0;
    core::WorldPosition position;
    double radius_m = 0;
    std::vector<visibility::NodeCoord> nodes;  // whose ground and models it shows
    std::vector<Mesh> meshes;
    double sun_azimuth_deg = 0, sun_elevation_deg = 0;  // that its ground is lit by
    float pixels_per_radian = 0;                        // of the picture it is for
    std::uint64_t bytes = 0;
    Readiness readiness;
    bool told = false;
    bool stale = false;  // the meshes are not these any more, since edits or another preset
  };
  std::vector<Place> places;
  PlaceId last_id = 0;
};

// What decides which meshes a place needs.
struct PlaceRules {
  const Settings& settings;
  const WorldFacts& facts;
  const Camera& camera;
  const Quality& quality;
  const Daylight& daylight;
};

// Wants what is missing of all places, keeps what is there, and tells which became ready. Follows
// edits and the sun. Part of the cache system. O(meshes of all places); a place whose nodes were
// edited is listed anew.
void want_places(const PlaceRules& rules, Foresight& foresight, synthesis::MeshSupply& meshes,
                 ecs::EventQueue<PlaceReady>& ready);

}  // namespace psygen::scene
