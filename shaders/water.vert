// A plane of water around the camera, out to the horizon: square rings that grow outwards, computed
// from the vertex number. Each ring is a strip with two vertices for each of PSYGEN_WATER_SIDES
// corners, and two more vertices join it to the next ring.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "atmosphere.glsl"
#include "lighting.glsl"
#include "lamps.glsl"
#include "water.glsl"

#ifdef PSYGEN_PIXEL_LIGHT
layout(location = 0) out vec3 place;
#else
layout(location = 0) out vec3 colour;
#endif

// Corner `i` of a ring, on the border of the square from -1 to 1.
vec2 on_square(int i) {
  int side = i / (PSYGEN_WATER_SIDES / 4);
  float along = float(i - side * (PSYGEN_WATER_SIDES / 4)) * (8.0 / float(PSYGEN_WATER_SIDES)) - 1.0;
  vec2 p = (side & 1) == 0 ? vec2(along, -1.0) : vec2(1.0, along);
  return (side & 2) == 0 ? p : -p;
}

void main() {
  int ring = gl_VertexIndex / PSYGEN_WATER_STRIP;
  int within = clamp(gl_VertexIndex - ring * PSYGEN_WATER_STRIP - 1, 0, PSYGEN_WATER_STRIP - 3);
  int outwards = ring + (within & 1);
  float least = 0.3 * max(abs(frame.water.w), 1.0);
  float radius = outwards == 0 ? 0.0
                 : least * exp2(float(outwards) * (1.0 / float(PSYGEN_WATER_RINGS)) *
                                log2(PSYGEN_WATER_REACH / least));
  vec2 plane = on_square((within >> 1) % PSYGEN_WATER_SIDES) * radius;
  vec3 p = vec3(plane.x, frame.water.w, plane.y);
#ifdef PSYGEN_PIXEL_LIGHT
  place = p;
#else
  vec3 light = water_light(p, vec3(0, 1, 0));
  if (lamps) light += frame.water.rgb * lamp_light(p, vec3(0, 1, 0), 0.0);
  colour = shown(through_haze(light, p));
#endif
  gl_Position = frame.clip_from_camera * vec4(p, 1.0);
}
