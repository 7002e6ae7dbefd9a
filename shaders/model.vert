// Trees, rocks and all other models: unpacks core::ModelVertex, turns billboards, applies wind,
// light and haze. With PSYGEN_PICTURE some vertices may be those of pictures (pictures.glsl). With
// PSYGEN_OBJECT: a game's own objects (core::ObjectVertex), which are turned and scaled, and have a
// material. On software devices all of this is per vertex, and the fragment shader only writes the
// colour; with PSYGEN_MODEL_DETAIL, for near models, it adds a texture (model_detail.frag).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "draw.glsl"
#include "atmosphere.glsl"
#include "lighting.glsl"
#include "lamps.glsl"
#include "under_water.glsl"
#if defined(PSYGEN_PIXEL_LIGHT) && !defined(PSYGEN_OBJECT) && !defined(PSYGEN_PICTURE)
#define PSYGEN_SURFACES
#endif
#include "surface_out.glsl"
#ifdef PSYGEN_OBJECT
#include "materials.glsl"
#endif

layout(location = 0) in uvec4 packed;  // position, ambient, sway, normal, colour, material
#ifdef PSYGEN_OBJECT
layout(location = 1) in vec2 texture_place;
#endif

vec2 snorm16(uint v) {
  return max(vec2(int(v << 16) >> 16, int(v) >> 16) * (1.0 / 32767.0), -1.0);
}

// A smooth wave of period 1 in [-1, 1], without trigonometric functions, which are loops over lanes
// on software devices.
float wave(float t) {
  float f = abs(fract(t) * 2.0 - 1.0);
  return (f * f * (3.0 - 2.0 * f)) * 2.0 - 1.0;
}

// The horizontal unit direction to `p`, from the camera or (for shadows) from the sun.
vec2 ahead_of_viewer(vec3 p) {
#ifdef PSYGEN_SHADOW
  vec2 ahead = -frame.sun_direction.xz;
#else
  vec2 ahead = p.xz;
#endif
  ahead.x += 1e-6;
  return ahead * inversesqrt(dot(ahead, ahead));
}

#ifdef PSYGEN_PICTURE
// The direction `d` as the number of a view, 0 to below PSYGEN_PICTURE_VIEWS: 0 along +x, a quarter
// of all along +z. Exact at multiples of 45 degrees, without trigonometric functions.
float view_along(vec2 d) {
  float across = d.x / (abs(d.x) + abs(d.y) + 1e-9);
  return (d.y >= 0.0 ? 1.0 - across : 3.0 + across) * (PSYGEN_PICTURE_VIEWS / 4.0);
}
#endif

// `v` turned by the unit quaternion `q`.
vec3 turned(vec4 q, vec3 v) {
  vec3 t = 2.0 * cross(q.xyz, v);
  return v + q.w * t + cross(q.xyz, t);
}

void main() {
  DrawData draw = this_draw();
  vec2 xy = snorm16(packed.x);
  float z = max(float(int(packed.y << 16) >> 16) * (1.0 / 32767.0), -1.0);
  float ambient = float((packed.y >> 16) & 0xFFu) * (1.0 / 255.0);
  float sway = float(packed.y >> 24) * (1.0 / 255.0);
  vec3 n = octahedral_normal(snorm16(packed.z));
  vec3 c = vec3(packed.w & 0xFFu, (packed.w >> 8) & 0xFFu, (packed.w >> 16) & 0xFFu) * (1.0 / 255.0);
  vec3 albedo = c * c;
  uint material = packed.w >> 24;
  float leaf = float(material & 1u);

#ifdef PSYGEN_PICTURE
  uv = vec2(0.0);
  layers = vec2(0.0);
#endif
#ifdef PSYGEN_OBJECT
  float number = floor(draw.origin.w);
  vec3 p = draw.origin.xyz + turned(draw.turn, draw.scale.xyz * vec3(xy, z));
  vec3 across = turned(draw.turn, n * draw.light.yzw);
  n = across * inversesqrt(max(dot(across, across), 1e-20));
#else
  vec3 p = draw.origin.xyz + draw.scale.xyz * vec3(xy, z);
#endif
  if ((material & PSYGEN_BILLBOARD_BIT) != 0u) {
    vec2 ahead = ahead_of_viewer(p);
    vec2 right = vec2(-ahead.y, ahead.x);
    vec2 aside = snorm16(packed.z) * PSYGEN_BILLBOARD_REACH_M;
    p.xz += aside.x * right + aside.y * ahead;
    vec2 flat_n = 0.7 * (sign(aside.x) * right - ahead);  // as of a round crown
    n = normalize(vec3(flat_n.x, 0.35 + 0.7 * sign(aside.y), flat_n.y));
#ifdef PSYGEN_PICTURE
    if ((material & PSYGEN_PICTURE_BIT) != 0u) {
      float view = view_along(ahead) + float(packed.w & 7u);
      layers = vec2(1.0 + float(packed.w & 0xF8u), view);
      uv = c.yz;
      albedo = vec3(1.0);
    }
#endif
  }
#ifdef PSYGEN_OBJECT
  float time = frame.sun_direction.w * 0.31 + draw.origin.w - number;
#else
  float time = frame.sun_direction.w * 0.31 + draw.origin.w;
#endif
#ifdef PSYGEN_SURFACES
  still_place = p;
#endif
#ifdef PSYGEN_MODEL_DETAIL
  const float kRepeatsPerM = float(PSYGEN_GROUND_REPEATS) / float(PSYGEN_GROUND_PERIOD_M);
  vec3 anchor = vec3(frame.ground_anchor.x, frame.horizon_colour.w, frame.ground_anchor.y);
  detail_place = fract(anchor * kRepeatsPerM) + p * kRepeatsPerM;  // small: its slopes are exact
  float stone = draw.light.y == float(PSYGEN_SURFACE_STONE) ? 1.0 : 0.0;
  detail_shares = (1.0 - smoothstep(0.5, 1.0, length(p) * (1.0 / float(PSYGEN_NEAR_MODELS_M)))) *
                  vec3(leaf, (1.0 - leaf) * (1.0 - stone), (1.0 - leaf) * stone);
  detail_shares *= kept_by_water(water_over(p.y)).g;
#endif
  p.x += sway * 0.12 * wave(time + xy.y * 0.3);
  p.z += sway * 0.09 * wave(time * 1.37 + xy.x * 0.4);

#if defined(PSYGEN_PICTURE) && !defined(PSYGEN_PIXEL_LIGHT) && !defined(PSYGEN_SHADOW)
  air = vec3(0.0);
#endif
#if defined(PSYGEN_FADING)
  fade = draw.scale.w;
#elif defined(PSYGEN_OBJECT)
  fade = draw.scale.w;
  uv = texture_place;
  material_number = uint(max(number, 0.0));
#endif
#if defined(PSYGEN_DRAW_COLOUR)
  colour = colour_of_draw(draw.origin.w, n);
#elif defined(PSYGEN_PIXEL_LIGHT)
  place = p;
  normal = n;
  albedo_ambient = vec4(albedo, ambient);
  sun_leaf_surface = vec3(draw.light.x, leaf, 0.0);
#ifdef PSYGEN_SURFACES
  bool leaves = leaf > 0.5 && draw.light.y > 0.5;
  sun_leaf_surface.z = leaves ? float(PSYGEN_SURFACE_LEAVES) : draw.light.y;
#endif
#elif !defined(PSYGEN_SHADOW) && defined(PSYGEN_OBJECT)
  MaterialData m = materials[uint(number)];
  albedo *= m.base.rgb;
  vec3 light = model_light(albedo, n, p, ambient, leaf, draw.light.x) +
               m.emissive.rgb * frame.sun_colour.w;
  if (lamps) light += albedo * ambient * lamp_light(p, n, 0.5 * leaf);
  colour = shown(through_water_and_haze(light, p));
#elif !defined(PSYGEN_SHADOW)
  vec3 light = model_light(albedo, n, p, ambient, leaf, draw.light.x);
  if (lamps) light += albedo * ambient * lamp_light(p, n, 0.5 * leaf);
#ifdef PSYGEN_PICTURE
  vec3 kept, left = kept_by_water(water_over(p.y));
  air = haze(in_air(p), kept) + frame.deep_water.rgb * (1.0 - left) * kept;
  colour = light * left * kept;
#else
  colour = shown(through_water_and_haze(light, p));
#endif
#endif
  gl_Position = clip_matrix() * vec4(p, 1.0);
}
