// The sun's direction that lights the ground, in worlds that have a day. When its shadows have
// moved by a step, the ground of every node gets new parameters. The old mesh is drawn until the
// new one is ready, as after any other request. Main thread only.
#pragma once

#include "ecs/ecs.hpp"
#include "engine/scene/components.hpp"

namespace psygen::scene {

struct Clock;
struct WorldFacts;

// The direction that world::set_sun() has set.
struct Daylight {
  double azimuth_deg = 0, elevation_deg = 90;
  friend bool operator==(const Daylight&, const Daylight&) = default;
};

// System: moves the sun. O(nodes) if the shadows moved by a step.
using DaylightQuery = ecs::Query<const QuadtreeNode, MeshSource, MeshDemand>;
void daylight_system(const Clock& clock, const WorldFacts& facts, DaylightQuery nodes,
                     Daylight& daylight);

}  // namespace psygen::scene
