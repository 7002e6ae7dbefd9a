// Light and haze for each pixel of a mesh, with the sun's shadows and fine grain on near ground if
// the preset has them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "atmosphere.glsl"
#include "lighting.glsl"
#include "ground.glsl"
#include "fading.glsl"

layout(constant_id = 0) const bool fine_grain = false;
layout(constant_id = 1) const bool shadows = false;
layout(set = 0, binding = PSYGEN_BINDING_SHADOWS) uniform sampler2DArrayShadow shadow_maps;
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 albedo_ambient;
// x: share of the sun that no terrain hides; y: leaf; z: 1 on ground
layout(location = 3) in vec3 sun_leaf_ground;
layout(location = 0) out vec4 pixel;

// Visible share of the sun in the shadow maps, from nine texels around `p`.
float sun_at(vec3 p, vec3 n) {
  float away = length(p);
  int last = int(frame.shadow.y) - 1;
  int cascade = away < frame.shadow_reach.x ? 0 : away < frame.shadow_reach.y ? 1 : 2;
  if (last < 0) return 1.0;
  float end = frame.shadow_reach[last];
  if (cascade > last || away > end) return 1.0;
  float texel_m = 2.0 * frame.shadow_reach[cascade] * frame.shadow.x;
  vec3 off = (n + frame.sun_direction.xyz) * (1.5 * texel_m);  // prevents self-shadowing
  vec3 q = (frame.shadow_from_camera[cascade] * vec4(p + off, 1.0)).xyz;
  vec2 uv = q.xy * 0.5 + 0.5;
  float lit = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x)
      lit += texture(shadow_maps, vec4(uv + vec2(x, y) * frame.shadow.x, float(cascade), q.z));
  }
  return mix(lit * (1.0 / 9.0), 1.0, smoothstep(0.85 * end, end, away));
}

void main() {
  leave_out_faded();
  vec3 n = normalize(normal);
  vec3 albedo = albedo_ambient.rgb;
  if (fine_grain && sun_leaf_ground.z > 0.5) {
    vec2 plane = place.xz + frame.ground_anchor.xy;
    float near = 1.0 - smoothstep(30.0, 150.0, length(place));
    float grain = 0.4 * slow_noise(plane * 0.5) + 0.6 * slow_noise(plane * 4.0);
    albedo *= 1.0 + 0.8 * frame.ground_colour.w * near * (grain - 0.5);
  }
  float sun = sun_leaf_ground.x * (shadows ? sun_at(place, n) : 1.0);
  vec3 light = sun_leaf_ground.z > 0.5
                   ? ground_light(albedo, n, sun, albedo_ambient.a)
                   : model_light(albedo, n, place, albedo_ambient.a, sun_leaf_ground.y, sun);
  pixel = vec4(shown(through_haze(light, place)), 1.0);
}
