// The surface of rivers and lakes: meshes of core::WaterVertex, whose draws are always pushed.
#version 460
#extension GL_GOOGLE_include_directive : require
#define PSYGEN_DRAW_PUSHED
#include "frame.glsl"
#include "draw.glsl"
#include "atmosphere.glsl"
#include "lighting.glsl"
#include "lamps.glsl"
#include "under_water.glsl"
#include "water.glsl"
#include "water_surface.glsl"

layout(location = 0) in uvec4 packed;  // position, depth, foam, flow, slope
#ifdef PSYGEN_PIXEL_LIGHT
layout(location = 0) out vec3 place;
layout(location = 1) out vec4 slope_depth_foam;
layout(location = 2) out vec2 flow;  // m/s
#else
layout(location = 0) out vec4 colour;  // to blend
#endif

vec2 snorm16(uint v) {
  return max(vec2(int(v << 16) >> 16, int(v) >> 16) * (1.0 / 32767.0), -1.0);
}

void main() {
  DrawData draw = this_draw();
  vec3 at = vec3(snorm16(packed.x), max(float(int(packed.y << 16) >> 16) * (1.0 / 32767.0), -1.0));
  float depth = float((packed.y >> 16) & 0xFFu) * (1.0 / 255.0);
  depth *= depth * PSYGEN_WATER_DEPTH_M;
  float foam = smoothstep(0.0, 1.0, float(packed.y >> 24) * (1.0 / 255.0));
  vec3 p = draw.origin.xyz + draw.scale.xyz * at;
  // Where a river or lake ends in the sea, the plane of the sea is the surface.
  bool at_sea = abs(p.y - frame.water.w) < 0.04;
  if (at_sea) p.y -= 0.06;
  vec2 slope = max(vec2(int(packed.w << 24) >> 24, int(packed.w << 16) >> 24) * (1.0 / 127.0), -1.0);
#ifdef PSYGEN_PIXEL_LIGHT
  place = p;
  slope_depth_foam = vec4(slope, depth, foam);
  flow = snorm16(packed.z) * PSYGEN_WATER_SPEED;
#else
  vec3 n = normalize(vec3(-slope.x, 1.0, -slope.y));
  WaterLight water = water_light(p, n);
  vec3 lit = vec3(0.0);
  if (lamps) lit = frame.water.rgb * lamp_light(p, n, 0.0);
  colour = surface_blend(water, lit, p, n, depth, foam);
#endif
  gl_Position = frame.clip_from_camera * vec4(p, 1.0);
  // Coarse ground may fill a narrow bed, so far surfaces have the depth of places nearer to the
  // camera.
  if (!at_sea) gl_Position.z /= 1.0 - 0.02 * smoothstep(60.0, 300.0, length(p));
}
