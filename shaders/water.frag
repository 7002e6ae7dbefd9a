// Light for each pixel of the water, with waves and the mirrored land (PSYGEN_MIRROR) if the preset
// has them. It is blended over what lies under the surface (water.glsl). With PSYGEN_FLOW: of rivers
// and lakes (water_surface.vert), whose waves and foam drift with the current.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "atmosphere.glsl"
#include "lighting.glsl"
#include "lamps.glsl"
#ifdef PSYGEN_MIRROR
#include "dither.glsl"
#include "mirror.glsl"
#endif
#include "water.glsl"
#ifdef PSYGEN_FLOW
#include "under_water.glsl"
#include "water_surface.glsl"
#endif

layout(constant_id = 0) const bool waves = false;
layout(set = 0, binding = PSYGEN_BINDING_CLOUDS) uniform sampler2D noises;
layout(location = 0) in vec3 place;
#ifdef PSYGEN_FLOW
layout(location = 1) in vec4 slope_depth_foam;
layout(location = 2) in vec2 flow;  // m/s
#endif
layout(location = 0) out vec4 pixel;

// Slope of waves. `length_m`: period of their pattern, a divisor of 2048 m. `drift`: its movement,
// in periods per second.
vec2 slope_of(vec2 plane, float length_m, vec2 drift) {
  vec2 at = plane / length_m + drift * frame.sun_direction.w;
  const float texel = 2.0 / 256.0;
  float here = texture(noises, at).g;
  return vec2(texture(noises, at + vec2(texel, 0)).g - here,
              texture(noises, at + vec2(0, texel)).g - here);
}

#ifdef PSYGEN_FLOW
// Patterns that drift with the flow: two of them, each from its place so many seconds ago, and the
// share of the second. Each starts anew while the other one is seen.
const float kDriftSeconds = 6.0;
struct Drift {
  vec2 first, second;
  float share;
};
Drift drift_of(vec2 plane) {
  float turn = frame.sun_direction.w * (1.0 / kDriftSeconds);
  float a = fract(turn), b = fract(turn + 0.5);
  return Drift(plane - flow * (a * kDriftSeconds), plane - flow * (b * kDriftSeconds) + 117.0,
               abs(1.0 - 2.0 * a));
}
vec2 drifting_slope(Drift d, float length_m) {
  return mix(slope_of(d.first, length_m, vec2(0.0)), slope_of(d.second, length_m, vec2(0.0)),
             d.share);
}
float drifting_noise(Drift d, float length_m) {
  return mix(texture(noises, d.first / length_m).g, texture(noises, d.second / length_m).g, d.share);
}
#endif

// The reflections of lamps in ripples, as the sun's in water_light().
vec3 lamp_glint(vec3 p, vec3 n) {
  vec3 v = normalize(p);
  vec3 sum = vec3(0.0);
  int count = lamp_count_at(p);
  for (int i = 0; i < count; ++i) {
    vec3 to_lamp;
    vec3 light = lamp_at(i, p, to_lamp);
    vec3 h = to_lamp - v;
    vec2 slope = h.xz / max(h.y, 1e-3) - n.xz / n.y;
    float steep = dot(slope, slope);
    sum += light * (1.3 * exp(-400.0 * steep) + 0.2 * exp(-45.0 * steep));
  }
  return sum;
}

void main() {
  vec3 n = vec3(0, 1, 0);
  vec2 plane = place.xz + frame.ground_anchor.xy;
  float near = 1.0 / (1.0 + dot(place, place) * (1.0 / 250000.0));
#ifdef PSYGEN_FLOW
  Drift drift = drift_of(plane);
  float fast = clamp(length(flow) * (1.0 / 2.0), 0.0, 1.0);
  vec2 slope = slope_depth_foam.xy;
  if (waves)
    slope += (drifting_slope(drift, 16.0) * (0.15 + 0.5 * fast) + 0.5 * drifting_slope(drift, 64.0)) * near;
  n = normalize(vec3(-slope.x, 1.0, -slope.y));
#else
  if (waves) {
    vec2 slope = slope_of(plane, 32.0, vec2(0.020, 0.008)) +
                 slope_of(plane.yx, 128.0, vec2(-0.006, 0.009));
    n = normalize(vec3(-slope.x * near, 1.0, -slope.y * near));
  }
#endif
  WaterLight water = water_light(place, n);
  vec3 lit = vec3(0.0);
  if (lamps) {
    lit = frame.water.rgb * lamp_light(place, n, 0.0);
    water.all += lit + lamp_glint(place, n);
  }
#ifdef PSYGEN_FLOW
  // Foam breaks up into streaks; the mean of its noise is one half.
  float streaks = mix(0.5, drifting_noise(drift, 8.0), 1.0 / (1.0 + dot(place, place) * (1.0 / 10000.0)));
  float foam = slope_depth_foam.w;
  foam *= smoothstep(0.72 - 0.6 * foam, 0.92 - 0.5 * foam, streaks + 0.25);
  pixel = surface_blend(water, vec3(0.0), place, n, slope_depth_foam.z, foam);
#else
  pixel = water_blend(water, lit, place);
#endif
}
