// Light for each pixel of the water, with waves and the mirrored land (PSYGEN_MIRROR) if the preset
// has them. It is blended over what lies under the surface (water.glsl).
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

layout(constant_id = 0) const bool waves = false;
layout(set = 0, binding = PSYGEN_BINDING_CLOUDS) uniform sampler2D noises;
layout(location = 0) in vec3 place;
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
  if (waves) {
    vec2 plane = place.xz + frame.ground_anchor.xy;
    float near = 1.0 / (1.0 + dot(place, place) * (1.0 / 250000.0));
    vec2 slope = slope_of(plane, 32.0, vec2(0.020, 0.008)) +
                 slope_of(plane.yx, 128.0, vec2(-0.006, 0.009));
    n = normalize(vec3(-slope.x * near, 1.0, -slope.y * near));
  }
  WaterLight water = water_light(place, n);
  vec3 lit = vec3(0.0);
  if (lamps) {
    lit = frame.water.rgb * lamp_light(place, n, 0.0);
    water.all += lit + lamp_glint(place, n);
  }
  pixel = water_blend(water, lit, place);
}
