// Light and haze for each pixel of the ground, with the sun's shadows if the preset has them. Kinds
// of ground have textures (ground_textures.hpp): in presets with fine grain (RICH) up to some
// hundred metres with normals and gloss, else on near ground (PSYGEN_NEAR_GROUND) only in colour.
// Patches vary the colour at any distance.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "atmosphere.glsl"
#include "lighting.glsl"
#include "lamps.glsl"
#include "under_water.glsl"
#include "ground.glsl"
#include "shadows.glsl"
#include "clouds.glsl"
#include "cloud_shadow.glsl"
#include "shore.glsl"
#include "foam.glsl"
#include "texture_look.glsl"
#ifdef PSYGEN_NEAR_GROUND
#include "ground_shade.glsl"
#endif

layout(constant_id = 1) const bool shadows = false;
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 pattern_grain_cover_ambient;
layout(location = 3) in vec3 sun_leaf_surface;  // x: share of the sun that no terrain hides
layout(location = 0) out vec4 pixel;

// Numbers of textures.
const float kRock = float(PSYGEN_TEXTURE_ROCK), kScree = float(PSYGEN_TEXTURE_SCREE);
const float kPatches = float(PSYGEN_TEXTURE_PATCHES);

// A kind is seen at a second scale, turned against the first, so that repetition does not show.
Look look_from(float kind, vec2 p, vec3 u, vec3 v, float lod) {
  Look look = look_at(kind, p, u, v, lod);
  if (fine_grain) {
    vec2 turned = vec2(3.0 * p.x + 4.0 * p.y, 3.0 * p.y - 4.0 * p.x) * (45.0 / kPeriod);
    look.colour.rgb *= 0.4 + 1.2 * textureLod(textures, vec3(turned, kind), lod - 1.2).rgb;
  }
  return look;
}

// Rock is seen from the side where it is steep, all else from above. `at`: place in the pattern
// and height.
Look look_of(float kind, vec3 at, vec3 n, float lod) {
  const vec3 x = vec3(1, 0, 0), y = vec3(0, 1, 0), z = vec3(0, 0, 1);
  float aside = abs(n.x) > abs(n.z) ? 1.0 : 0.0;
  bool steep = kind == kRock;
  if (!fine_grain) {
    steep = steep && n.y < 0.75;
    vec2 side = aside > 0.5 ? at.zy : at.xy;
    return look_from(kind, steep ? side : at.xz, x, z, lod);
  }
  Look look = look_from(kind, at.xz, x, z, lod);
  if (!steep || n.y > 0.85) return look;
  float share = smoothstep(-0.12, 0.12, abs(n.x) - abs(n.z));
  Look side = mixed(look_from(kind, at.xy, x, y, lod), look_from(kind, at.zy, z, y, lod), share);
  return mixed(look, side, smoothstep(0.85, 0.68, n.y));
}

// The two kinds with the largest shares, their shares and albedos.
struct Kinds {
  float first, second, first_share, second_share;
  vec3 first_albedo, second_albedo;
};

void add_kind(float kind, float share, vec3 albedo, inout Kinds k) {
  if (share > k.first_share) {
    k.second = k.first;
    k.second_share = k.first_share;
    k.second_albedo = k.first_albedo;
    k.first = kind;
    k.first_share = share;
    k.first_albedo = albedo;
  } else if (share > k.second_share) {
    k.second = kind;
    k.second_share = share;
    k.second_albedo = albedo;
  }
}

Kinds kinds_of(Blends b) {
  Kinds k = Kinds(5.0, 0.0, b.snow, 0.0, frame.snow.rgb, frame.grass.rgb);
  float left = (1.0 - b.snow) * (1.0 - b.canopy);
  float scree = 1.0 - smoothstep(0.45, 0.9, b.rock);
  add_kind(kRock, left * b.rock * (1.0 - scree), frame.rock.rgb, k);
  add_kind(kScree, left * b.rock * scree, frame.rock.rgb, k);
  left *= 1.0 - b.rock;
  add_kind(3.0, left * b.sand, frame.sand.rgb, k);
  left *= 1.0 - b.sand;
  add_kind(2.0, left * b.dry, frame.dry.rgb, k);
  left *= 1.0 - b.dry;
  add_kind(1.0, left * b.forest, frame.forest.rgb, k);
  add_kind(0.0, left * (1.0 - b.forest), frame.grass.rgb, k);
  return k;
}

// The patches' factor of the albedo at `p`, turned and scaled by `step`, minus 1. From where a whole
// row of them is in view it is weaker, because then they are seen to repeat.
vec3 patch_at(vec2 p, vec2 step, float lod) {
  vec2 turned = vec2(step.x * p.x + step.y * p.y, step.x * p.y - step.y * p.x) * (1.0 / kPeriod);
  float own_lod = lod + log2(length(step) * (1.0 / float(PSYGEN_GROUND_REPEATS)));
  vec3 t = textureLod(textures, vec3(turned, kPatches), own_lod).rgb * 2.0 - 1.0;
  return t * mix(1.0, 0.3, smoothstep(1.0, 3.5, own_lod));
}

// Factor of the albedo that varies over tens and hundreds of metres.
vec3 patches(vec2 p, float lod) {
  vec3 far = 1.0 + 0.75 * (patch_at(p, vec2(12.0, 3.0), lod) + patch_at(p, vec2(5.0, 3.0), lod));
  return fine_grain ? far * (1.0 + patch_at(p, vec2(72.0, -36.0), lod)) : far;
}

// Light of the sun from rough surfaces (Trowbridge and Reitz 1975), for Fresnel's 4 percent.
float gloss(vec3 n, vec3 v, float rough) {
  vec3 h = frame.sun_direction.xyz - v;
  float across = dot(n, h) * inversesqrt(max(dot(h, h), 1e-6));
  float a2 = rough * rough * rough * rough;
  float d = across * across * (a2 - 1.0) + 1.0;
  return 0.012 * a2 / max(d * d, 1e-4);
}

void main() {
  vec3 n = normalize(normal);
  float grain = pattern_grain_cover_ambient.y;
  Blends b = blends_of(place.y + frame.horizon_colour.w, n, pattern_grain_cover_ambient.x,
                       pattern_grain_cover_ambient.z);
  vec3 albedo = blended_albedo(b, grain);
  vec3 at = place_of_textures(place);
  float away = length(place);
  vec3 v = place / max(away, 1e-3);
  float lod = lod_of_textures(away, dot(v, n));
  albedo *= mix(vec3(1.0), patches(at.xz, lod), (1.0 - 0.7 * b.snow) * frame.ground_colour.w);
  float ambient = pattern_grain_cover_ambient.w;
  float rough = 1.0, shine = 0.0;
  float sun = sun_leaf_surface.x;
#ifdef PSYGEN_NEAR_GROUND
  if (away < float(PSYGEN_NEAR_GROUND_M)) {
    vec2 left = left_by_spots(place);
    sun *= left.x;
    ambient *= left.y;
  }
  float reach = fine_grain ? 400.0 : float(PSYGEN_NEAR_GROUND_M);
  float near = (1.0 - smoothstep(0.4 * reach, reach, away)) * frame.ground_colour.w;
  if (near > 0.0) {
    Kinds k = kinds_of(b);
    Look look = look_of(k.first, at, n, lod);
    vec3 c = k.first_albedo * look.colour.rgb;
    if (k.second_share > 0.01) {
      Look other = look_of(k.second, at, n, lod);
      // The higher one of two kinds shows first.
      float lead = k.first_share - k.second_share + 0.7 * (look.colour.a - other.colour.a);
      float share = (1.0 - smoothstep(-0.2, 0.2, lead)) * smoothstep(0.01, 0.1, k.second_share);
      c = mix(c, k.second_albedo * other.colour.rgb, share);
      look = mixed(look, other, share);
    }
    // Kinds with less than the second share, and forests, keep their smooth blend.
    float both = k.first_share + k.second_share;
    vec3 smooth_ = (k.first_share * k.first_albedo + k.second_share * k.second_albedo) / both;
    albedo = mix(albedo, albedo * c / max(smooth_, vec3(1e-4)), near * both);
    n = normalize(n + look.bump * (1.4 * near));
    rough = look.rough;
    ambient *= mix(1.0, look.open, near);
    shine = fine_grain ? near : 0.0;
  }
#endif
  if (shadows) sun *= sun_at(place, normalize(normal)) * left_by_clouds(place);
  float depth = frame.water.w - place.y;
  albedo *= wet_at(depth);
  vec3 light = ground_light(albedo, n, sun, ambient);
  const vec3 white = vec3(0.7), up = vec3(0, 1, 0);
  vec3 foam = ground_light(white, up, sun, ambient);
  if (lamps) {
    light += albedo * lamp_light(place, n, 0.0);
    foam += white * lamp_light(place, up, 0.0);
  }
  if (fine_grain)
    light += frame.sun_colour.rgb *
             (shine * sun * max(dot(n, frame.sun_direction.xyz), 0.0) * gloss(n, v, rough));
  light = through_water(light, max(depth, 0.0));
  light = mix(light, foam, foam_at(place, normalize(normal).y));
  pixel = vec4(shown(through_haze(light, in_air(place))), 1.0);
}
