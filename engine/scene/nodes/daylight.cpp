#include "engine/scene/nodes/daylight.hpp"

#include "engine/scene/facts/world_facts.hpp"
#include "engine/scene/frame/clock.hpp"
#include "engine/world/placement.hpp"

namespace psygen::scene {
namespace {

bool is_same_step(const Daylight& a, const Daylight& b) {
  models::Parameters of_a, of_b;
  world::set_sun(of_a, a.azimuth_deg, a.elevation_deg);
  world::set_sun(of_b, b.azimuth_deg, b.elevation_deg);
  return of_a == of_b;
}

}  // namespace

void daylight_system(const Clock& clock, const WorldFacts& facts, DaylightQuery nodes,
                     Daylight& daylight) {
  const world::Sky sky = world::sky_at(facts.world.sky, clock.now_s);
  const Daylight now{sky.sun_azimuth_deg, sky.sun_elevation_deg};
  if (is_same_step(now, daylight)) return;
  daylight = now;
  const models::ModelType& terrain = facts.registry[facts.world.terrain_model];
  nodes.each<const QuadtreeNode, MeshSource, MeshDemand>(
      [&](auto, auto, auto sources, auto demands) {
        for (std::size_t i = 0; i < sources.size(); ++i) {
          models::Parameters lit = sources[i].parameters;
          world::set_sun(lit, daylight.azimuth_deg, daylight.elevation_deg);
          if (lit == sources[i].parameters) continue;
          sources[i].parameters = lit;
          sources[i].parameters_hash = models::parameters_hash(terrain, lit);
          demands[i].stale = demands[i].drawn_level != kNoLevel;
          demands[i].requested_level = kNoLevel;
          demands[i].failed_levels = 0;
        }
      });
}

}  // namespace psygen::scene
