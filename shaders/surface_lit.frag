// Light and haze for each pixel of a model, with the sun's shadows if the preset has them. With
// PSYGEN_PICTURE some of it may have pictures.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "atmosphere.glsl"
#include "lighting.glsl"
#include "lamps.glsl"
#include "under_water.glsl"
#include "fading.glsl"
#include "shadows.glsl"
#include "clouds.glsl"
#include "cloud_shadow.glsl"
#include "pictures.glsl"
#ifndef PSYGEN_PICTURE
#include "surface_detail.glsl"
#endif

layout(constant_id = 1) const bool shadows = false;
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 albedo_ambient;
// x: share of the sun that no terrain hides; y: leaf; z: PSYGEN_SURFACE_…
layout(location = 3) in vec3 sun_leaf_surface;
#ifndef PSYGEN_PICTURE
layout(location = 8) in vec3 still_place;
#endif
layout(location = 0) out vec4 pixel;

void main() {
#ifdef PSYGEN_PICTURE
  vec4 texel = picture();  // first: derivatives are undefined after a discard
#endif
  leave_out_faded();
  vec3 albedo = albedo_ambient.rgb;
#ifdef PSYGEN_PICTURE
  if (texel.a < 0.5) discard;
  albedo *= texel.rgb;
#endif
  vec3 n = normalize(normal);
  float ambient = albedo_ambient.a;
  float sun = sun_leaf_surface.x * (shadows ? sun_at(place, n) * left_by_clouds(place) : 1.0);
#ifndef PSYGEN_PICTURE
  add_detail(int(sun_leaf_surface.z + 0.5), still_place, albedo, n, ambient);
#endif
  vec3 light = model_light(albedo, n, place, ambient, sun_leaf_surface.y, sun);
  if (lamps) light += albedo * ambient * lamp_light(place, n, 0.5 * sun_leaf_surface.y);
  pixel = vec4(shown(through_water_and_haze(light, place)), 1.0);
}
