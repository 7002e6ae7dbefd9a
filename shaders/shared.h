// The structures that GLSL and C++ share, each written once. Only vec4 and mat4, so that std140,
// std430 and C++ agree without padding. Metres, seconds, linear light multiplied by the exposure.
// Positions are relative to the camera; directions are in world space.
#ifndef PSYGEN_SHADERS_SHARED_H
#define PSYGEN_SHADERS_SHARED_H

#ifdef __cplusplus
#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
namespace psygen::shaders {
using glm::mat4;
using glm::vec4;
#endif

#define PSYGEN_BINDING_FRAME 0
#define PSYGEN_BINDING_DRAWS 1
#define PSYGEN_BINDING_CLOUDS 2
#define PSYGEN_BINDING_FONT 3
#define PSYGEN_BINDING_GLYPHS 4

// Everything that is the same for a whole frame.
struct FrameData {
  mat4 clip_from_camera;  // camera-relative world to clip space, reversed infinite depth
  vec4 ray_right;  // direction of a pixel = ray_forward + ndc.x · ray_right + ndc.y · ray_down
  vec4 ray_down;
  vec4 ray_forward;
  vec4 sun_direction;   // unit, towards the sun; w: seconds for wind and clouds
  vec4 sun_colour;      // w: haze density at the camera's height, 1/m
  vec4 zenith_colour;   // w: fall-off of the haze with height, 1/m
  vec4 horizon_colour;  // w: height of the camera, m
  vec4 ground_colour;   // light from below; w: strength of the ground pattern, 0 or 1
  vec4 haze_colour;     // w: cloud cover, 0 to 1
  vec4 ground_anchor;   // x, z: camera in the ground pattern, m; z, w: size of the picture
  vec4 grass;           // palette, linear; w: height where sand ends, m
  vec4 forest;          // w: height where dry meadow starts, m
  vec4 dry;             // w: blend of the dry meadow, m
  vec4 rock;            // w: slope (1 − normal.y) where rock starts
  vec4 snow;            // w: slope where everything is rock
  vec4 sand;            // w: blend of the sand, m
  vec4 snow_line;       // x: height where snow starts, m; y: blend, m; z: slope that sheds snow
};

// One terrain draw: x, z = origin + cell · grid; y = origin.y + range · height.
// One model draw:   p = center + half_extent · position.
struct DrawData {
  vec4 origin;  // terrain: origin, w cell size in m; model: center, w phase of the wind, 0 to 1
  vec4 scale;   // terrain: height range, skirt, morph, 0; model: half extent, w fade
};

// A corner of the overlay's quads.
struct OverlayVertex {
  vec4 place;   // pixels x, y; texture u, v
  vec4 colour;  // as shown, not linear; a covers what is below
};

#ifdef __cplusplus
static_assert(sizeof(FrameData) == 64 + 17 * 16);
static_assert(sizeof(DrawData) == 32);
static_assert(sizeof(OverlayVertex) == 32);
static_assert(offsetof(FrameData, ray_right) == 64);
}  // namespace psygen::shaders
#endif
#endif
