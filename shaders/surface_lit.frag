// Light and haze for each pixel of a mesh, with the sun's shadows and fine grain on near ground if
// the preset has them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "atmosphere.glsl"
#include "lighting.glsl"
#include "lamps.glsl"
#include "ground.glsl"
#include "fading.glsl"
#include "shadows.glsl"

layout(constant_id = 0) const bool fine_grain = false;
layout(constant_id = 1) const bool shadows = false;
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 albedo_ambient;
// x: share of the sun that no terrain hides; y: leaf; z: 1 on ground
layout(location = 3) in vec3 sun_leaf_ground;
layout(location = 0) out vec4 pixel;

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
  if (lamps) {
    light += albedo * mix(albedo_ambient.a, 1.0, sun_leaf_ground.z) *
             lamp_light(place, n, 0.5 * sun_leaf_ground.y);
  }
  pixel = vec4(shown(through_haze(light, place)), 1.0);
}
