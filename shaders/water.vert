// A plane of water around the camera, out to the horizon, computed from the vertex number. Columns go
// out from the camera and are closer together towards the sun, rings are closer together towards
// the horizon: there the light changes most, and with light per vertex the sun's path of glitter
// needs corners in and around it. Each column is a strip of PSYGEN_WATER_RINGS + 1 pairs, and two
// more vertices join it to the next.
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
layout(location = 0) out vec4 colour;  // to blend (water.glsl)
#endif

const float kTurn = 6.2831853;

// Azimuth from the sun's, for a column from -1 to 1. The path of glitter is narrower for a lower sun.
float azimuth_of(float t) {
  float up = frame.sun_direction.y;
  float width = clamp(0.27 * up * inversesqrt(max(1.0 - up * up, 1e-4)), 0.03, 0.3);
  float t2 = t * t;
  return t * (width + 0.2 * t2 + (0.8 - width) * t2 * t2) * (0.5 * kTurn);
}

// Distance of a ring whose part of the way to the horizon is `t`, from 0 to 1. Rings are so many
// degrees below the horizon: 90 times a power of 1 - t.
float radius_of(float t) {
  float below = 0.25 * kTurn * pow(1.0 - t, 2.6);
  float height = max(abs(frame.water.w), 0.5);
  return min(height * cos(below) / max(sin(below), 1e-7), PSYGEN_WATER_REACH);
}

void main() {
  int column = gl_VertexIndex / PSYGEN_WATER_STRIP;
  int within = clamp(gl_VertexIndex - column * PSYGEN_WATER_STRIP - 1, 0, PSYGEN_WATER_STRIP - 3);
  float around = float(column + (within & 1)) * (2.0 / float(PSYGEN_WATER_COLUMNS)) - 1.0;
  float azimuth = azimuth_of(around);
  vec2 sun = frame.sun_direction.xz;
  sun = dot(sun, sun) > 1e-8 ? sun * inversesqrt(dot(sun, sun)) : vec2(1.0, 0.0);
  float c = cos(azimuth), s = sin(azimuth);
  vec2 plane = vec2(sun.x * c - sun.y * s, sun.x * s + sun.y * c) *
               radius_of(float(within >> 1) * (1.0 / float(PSYGEN_WATER_RINGS)));
  vec3 p = vec3(plane.x, frame.water.w, plane.y);
#ifdef PSYGEN_PIXEL_LIGHT
  place = p;
#else
  vec3 up = vec3(0, 1, 0);
  WaterLight water = water_light(p, up);
  vec3 lit = vec3(0.0);
  if (lamps) lit = frame.water.rgb * lamp_light(p, up, 0.0);
  water.all += lit;
  colour = water_blend(water, lit, p);
#endif
  gl_Position = frame.clip_from_camera * vec4(p, 1.0);
}
