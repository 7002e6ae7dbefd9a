// Places that a game requests ahead of time: spawn points and teleports. A requested place is
// synthesised and kept at a lower priority than the frame, wherever the camera is. To wait for one
// instead, fill the cache (Session::prepare). Values.
#pragma once

#include <cstdint>

namespace psygen::scene {

// Meshes of a place: the ground and the models up to a radius, at the LODs that a camera there
// would choose.
struct Readiness {
  std::uint32_t meshes = 0;
  std::uint32_t missing = 0;  // of these, not in the cache
  double expected_s = 0;      // predicted time until all are ready, on all modelers; 0: they are
  bool ready() const { return missing == 0; }
};

// Maximum radius of a place, in metres.
inline constexpr double kMaxReadyRadiusM = 1000;

// Requested places get ids from 1 on. The event PlaceReady is emitted once for each, when all its
// meshes are ready.
using PlaceId = std::uint64_t;
struct PlaceReady {
  PlaceId id = 0;
};

}  // namespace psygen::scene
