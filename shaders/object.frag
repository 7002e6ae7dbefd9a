// Light and haze for each pixel of an object. With PSYGEN_TEXTURED its material has textures; with
// PSYGEN_FADING (fading.glsl) pixels are left out, also those of too little opacity.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "atmosphere.glsl"
#include "lighting.glsl"
#include "lamps.glsl"
#include "under_water.glsl"
#include "shadows.glsl"
#include "clouds.glsl"
#include "cloud_shadow.glsl"
#include "fading.glsl"
#include "materials.glsl"

layout(constant_id = 1) const bool shadows = false;
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 albedo_ambient;
layout(location = 3) in vec3 sun_leaf_surface;
layout(location = 5) in vec2 uv;
layout(location = 6) flat in uint material_number;
layout(location = 0) out vec4 pixel;

#ifdef PSYGEN_TEXTURED
// The normal map's normal. Its axes follow from how place and texture change from pixel to pixel,
// so vertices need no tangents (Schueler 2013, "Followup: Normal Mapping Without Precomputed
// Tangents").
vec3 mapped_normal(vec3 n, float strength) {
  vec3 px = dFdx(place), py = dFdy(place);
  vec2 tx = dFdx(uv), ty = dFdy(uv);
  vec3 a = cross(py, n), b = cross(n, px);
  vec3 t = a * tx.x + b * ty.x;
  vec3 s = a * tx.y + b * ty.y;
  float scale = inversesqrt(max(max(dot(t, t), dot(s, s)), 1e-20));
  vec3 m = texture(normal_map, uv).xyz * 2.0 - 1.0;
  m.xy *= strength;
  vec3 turned = (t * m.x + s * m.y) * scale + n * max(m.z, 1e-3);
  return turned * inversesqrt(max(dot(turned, turned), 1e-20));
}
#endif

void main() {
  MaterialData m = materials[material_number];
  uint options = uint(m.options.x);
  vec4 base = vec4(albedo_ambient.rgb, 1.0) * m.base;
  vec3 emitted = m.emissive.rgb;
  vec3 n = normalize(normal);
#ifdef PSYGEN_TEXTURED
  base *= texture(base_map, uv);
  emitted *= texture(emissive_map, uv).rgb;
  if ((options & PSYGEN_MATERIAL_NORMAL_MAP) != 0u) n = mapped_normal(n, m.options.y);
#endif
  leave_out_faded();
#ifdef PSYGEN_FADING
  if (base.a < m.emissive.w) discard;
#endif
  if ((options & PSYGEN_MATERIAL_TWO_SIDED) != 0u && dot(n, place) > 0.0) n = -n;
  float sun = sun_leaf_surface.x * (shadows ? sun_at(place, n) * left_by_clouds(place) : 1.0);
  vec3 light = model_light(base.rgb, n, place, albedo_ambient.a, sun_leaf_surface.y, sun);
  if (lamps) light += base.rgb * albedo_ambient.a * lamp_light(place, n, 0.5 * sun_leaf_surface.y);
  light += emitted * frame.sun_colour.w;
  pixel = vec4(shown(through_water_and_haze(light, place)), 1.0);
}
