// The colours of sun and sky for a height of the sun: light that is scattered once on its way
// through an atmosphere of air, dust and ozone, seen by an eye that has got used to it. Pure
// functions of the elevation; a few microseconds a call. Not part of any mesh: libm is fine here.
#pragma once

#include <glm/vec3.hpp>

namespace psygen::world {

// Relative radiance: only ratios of two of these mean something (Sky::light_at).
struct Daylight {
  glm::vec3 sun;      // on ground that faces it; 0 below the horizon
  glm::vec3 zenith;   // of the sky straight above
  glm::vec3 horizon;  // of the sky some way above the horizon, aside of the sun
  glm::vec3 haze;     // of the sky just above the horizon, aside of the sun
  glm::vec3 ground;   // from below
  glm::vec3 glow;     // what the sky is brighter around the sun, over `haze`
  glm::vec3 cloud;    // of the sun on clouds, which it reaches longer than the ground
};

// `sun_elevation_deg` in [-90, 90]. Smooth; every colour is > 0 but the sun's at night.
Daylight daylight(double sun_elevation_deg);

}  // namespace psygen::world
