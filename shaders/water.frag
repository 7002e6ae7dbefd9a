// Light for each pixel of the water, with waves if the preset has them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "atmosphere.glsl"
#include "lighting.glsl"
#include "water.glsl"

layout(constant_id = 0) const bool waves = false;
layout(set = 0, binding = PSYGEN_BINDING_CLOUDS) uniform sampler2D heights;
layout(location = 0) in vec3 place;
layout(location = 0) out vec4 pixel;

// Slope of waves. `length_m`: period of their pattern, a divisor of 2048 m. `drift`: its movement,
// in periods per second.
vec2 slope_of(vec2 plane, float length_m, vec2 drift) {
  vec2 at = plane / length_m + drift * frame.sun_direction.w;
  const float texel = 2.0 / 256.0;
  float here = texture(heights, at).r;
  return vec2(texture(heights, at + vec2(texel, 0)).r - here,
              texture(heights, at + vec2(0, texel)).r - here);
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
  pixel = vec4(shown(through_haze(water_light(place, n), place)), 1.0);
}
