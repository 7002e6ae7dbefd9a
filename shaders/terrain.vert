// Terrain: unpacks core::TerrainVertex, colours it by height, slope and a slow pattern, applies
// light and haze. On software devices all of this is per vertex, and the fragment shader only
// writes the colour.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "draw.glsl"
#include "atmosphere.glsl"
#include "lighting.glsl"
#include "lamps.glsl"
#include "ground.glsl"
#include "surface_out.glsl"
#include "under_water.glsl"
#include "shore.glsl"
#ifdef PSYGEN_GROUND_DETAIL
#include "ground_shade.glsl"
#endif

// x: grid x, grid z, height; y: coarse height, normal; z: sun, ambient, wet, road
layout(location = 0) in uvec3 packed;

void main() {
  DrawData draw = this_draw();
  vec2 grid = vec2(packed.x & 0x7Fu, (packed.x >> 8) & 0xFFu);
  float skirt = float((packed.x >> 7) & 1u);
  uint fine = packed.x >> 16;
  vec3 p = vec3(draw.origin.x + grid.x * draw.origin.w, 0.0,
                draw.origin.z + grid.y * draw.origin.w);
  float morph = draw.scale.z;
  if (morph < 0.0)
    morph = clamp((sqrt(dot(p.xz, p.xz)) - frame.morph.x) * frame.morph.y, 0.0, 1.0);
  float height = mix(float(fine), float(packed.y & 0xFFFFu), morph) * (1.0 / 65535.0);
  p.y = draw.origin.y + height * draw.scale.x;
  p.xz = clamp(p.xz, frame.edge.xy, frame.edge.zw);
  ivec2 bits = ivec2(int(packed.y << 8) >> 24, int(packed.y) >> 24);
  vec3 n = octahedral_normal(max(vec2(bits) * (1.0 / 127.0), -1.0));

  float grain = float((fine * 0x9E3779B1u) >> 24) * (1.0 / 255.0);
  vec2 visible = vec2(packed.z & 0xFFu, (packed.z >> 8) & 0xFFu) * (1.0 / 255.0);  // sun, sky
#if defined(PSYGEN_DRAW_COLOUR)
  colour = colour_of_draw(draw.scale.w, n);
#elif !defined(PSYGEN_SHADOW)
  visible *= 1.0 - 0.5 * float((packed.z >> 16) & 0xFFu) * (1.0 / 255.0);  // wet ground is darker
  float road = float(packed.z >> 24) * (1.0 / 255.0);
  float cover = road > 0.0 ? -road : draw.scale.w;
  vec2 plane = p.xz + frame.ground_anchor.xy;
  float pattern = ground_pattern(plane);
#if !defined(PSYGEN_PIXEL_LIGHT)
  Blends blends = blends_of(p.y + frame.horizon_colour.w, n, pattern, cover);
  vec3 albedo = blended_albedo(blends, grain);
#endif
#endif
#if defined(PSYGEN_GROUND_DETAIL)
  visible *= left_by_spots(p);
  float near = (1.0 - smoothstep(0.3, 1.0, length(p) * (1.0 / float(PSYGEN_NEAR_GROUND_M)))) *
               frame.ground_colour.w;
  vec4 share = vec4(near * (1.0 - blends.snow));
  share.z *= blends.rock;
  share.xyw *= 1.0 - blends.rock;
  share.w *= blends.sand;
  share.xy *= 1.0 - blends.sand;
  float floor_ = blends.forest * (1.0 - blends.dry);
  detail_shares = share * vec4(1.0 - floor_, floor_, 1.0, 1.0) +
                  vec4(0.0, 0.0, 0.0, 0.4 * near * blends.snow);
  detail_place = plane * (float(PSYGEN_GROUND_REPEATS) / float(PSYGEN_GROUND_PERIOD_M));
#endif
  p.y -= skirt * draw.scale.y;
#if defined(PSYGEN_PIXEL_LIGHT)
  place = p;
  normal = n;
  albedo_ambient = vec4(pattern, grain, cover, visible.y);
  sun_leaf_surface = vec3(visible.x, 0.0, 0.0);
#elif !defined(PSYGEN_DRAW_COLOUR) && !defined(PSYGEN_SHADOW)
  float depth = frame.water.w - p.y;
  albedo *= wet_at(depth);
  vec3 light = ground_light(albedo, n, visible.x, visible.y);
  if (lamps) light += albedo * lamp_light(p, n, 0.0);
  colour = shown(through_water_and_haze(light, p));
#endif
#if defined(PSYGEN_GROUND_DETAIL)
  detail_shares *= kept_by_water(water_over(p.y)).g;
  const vec3 white = vec3(0.7), up = vec3(0, 1, 0);
  vec3 foam = ground_light(white, up, visible.x, visible.y);
  if (lamps) foam += white * lamp_light(p, up, 0.0);
  float fades = smoothstep(0.7, 1.0, length(p) * (1.0 / float(PSYGEN_NEAR_GROUND_M)));
  // On steep banks foam would reach high up.
  shore.x = way_to_shore(depth, max(n.y, 0.93)) - swash_at(pattern);
  shore.y = 0.08 + slow_noise(0.75 * plane + 0.09 * frame.sun_direction.w) - 0.7 * fades;
  shore.z = dot(shown(through_water_and_haze(foam, p)), vec3(1.0 / 3.0));
#endif
  gl_Position = clip_matrix() * vec4(p, 1.0);
}
