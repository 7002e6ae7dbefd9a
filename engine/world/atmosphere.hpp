// The colours of sun and sky for an elevation of the sun: single scattering in an atmosphere of
// air, dust and ozone, as an eye sees it that has adapted to the brightness. Pure functions, any
// thread; a few microseconds a call. No mesh depends on the results, so they may use libm.
#pragma once

#include <glm/vec3.hpp>

namespace psygen::world {

// Relative radiance in red, green and blue. Only ratios between two values of this type have a
// meaning (with_sun() in world.hpp).
struct Daylight {
  glm::vec3 sun;      // on ground that faces the sun; 0 below the horizon
  glm::vec3 zenith;   // of the sky straight above
  glm::vec3 horizon;  // of the sky 14° above the horizon, 90° from the sun
  glm::vec3 haze;     // of the sky 4° above the horizon, 90° from the sun
  glm::vec3 ground;   // light from below
  glm::vec3 glow;     // additional brightness of the sky around the sun
  glm::vec3 cloud;    // sunlight on clouds, which lasts longer than on the ground
};

// The colours for an elevation of the sun, clamped to [-90, 90]. A smooth function. All values are
// > 0, except sun, cloud and glow at night.
Daylight daylight(double sun_elevation_deg);

}  // namespace psygen::world
