// The sky as a dome, for preset low. Each corner has the display values of the sky. Corners are
// closer together where the colour changes most: near the horizon and around the sun's azimuth.
// Each column is a strip of PSYGEN_DOME_ROWS pairs, and two more vertices join it to the next. The
// depth is 0, infinitely far.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "atmosphere.glsl"
#include "clouds.glsl"

layout(location = 0) out vec3 clear;       // display value without clouds
layout(location = 1) out vec4 cloud;       // x, y: texture coordinates, z: opacity, w: light
// The display value of a cloud in light w is about x + w · (y + w · z).
layout(location = 2) flat out vec3 shade_x;
layout(location = 3) flat out vec3 shade_y;
layout(location = 4) flat out vec3 shade_z;

const float kTurn = 6.2831853;

// Sine of the elevation of a row.
float height_of(int row) {
  float t = float(row) * (1.0 / float(PSYGEN_DOME_ROWS - 1));
  return sin(0.25 * kTurn * t * (0.25 + 0.75 * t));
}

vec3 shown_cloud(float sun) { return shown(frame.cloud_colour.rgb * sun + cloud_ambient()); }

void main() {
  int column = gl_VertexIndex / PSYGEN_DOME_STRIP;
  int within = clamp(gl_VertexIndex - column * PSYGEN_DOME_STRIP - 1, 0, PSYGEN_DOME_STRIP - 3);
  float around = float(column + (within & 1)) * (2.0 / float(PSYGEN_DOME_COLUMNS)) - 1.0;
  float azimuth = around * (0.5 + 0.5 * around * around) * 0.5 * kTurn;
  float y = height_of(within >> 1);
  vec2 glow = frame.glow_direction.xz;
  glow *= inversesqrt(max(dot(glow, glow), 1e-12));
  float c0 = cos(azimuth), s0 = sin(azimuth);
  vec2 plane = vec2(glow.x * c0 - glow.y * s0, glow.x * s0 + glow.y * c0) * sqrt(max(1.0 - y * y, 0.0));
  vec3 d = vec3(plane.x, y, plane.y);

  clear = shown(sky_light(d));
  cloud = vec4(cloud_place(d), cloud_presence(max(y, 0.0)),
               cloud_sun(dot(d, frame.sun_direction.xyz)));
  // The parabola through a dark, a medium and a bright cloud.
  const vec3 at = vec3(0.12, 0.35, 0.80);
  vec3 a = shown_cloud(at.x), b = shown_cloud(at.y), c = shown_cloud(at.z);
  vec3 slope = (b - a) / (at.y - at.x);
  shade_z = ((c - b) / (at.z - at.y) - slope) / (at.z - at.x);
  shade_y = slope - shade_z * (at.x + at.y);
  shade_x = a - at.x * (shade_y + at.x * shade_z);
  gl_Position = frame.clip_from_camera * vec4(d, 0.0);
  gl_Position.z = 0.0;
}
