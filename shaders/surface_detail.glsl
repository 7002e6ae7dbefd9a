// Textures of models near the camera: stone from all sides, bark along the trunk, and leaves
// with gaps between them.
#include "texture_look.glsl"

const float kDetailReach_m = 120.0;

const vec3 kX = vec3(1, 0, 0), kY = vec3(0, 1, 0), kZ = vec3(0, 0, 1);

// `share` of what faces x, the rest of what faces z, both turned by `scale`.
Look look_aside(float number, vec3 at, vec2 scale, float share, float lod) {
  if (share < 0.01) return look_at(number, at.xy * scale, kX, kY, lod);
  if (share > 0.99) return look_at(number, at.zy * scale, kZ, kY, lod);
  return mixed(look_at(number, at.xy * scale, kX, kY, lod),
               look_at(number, at.zy * scale, kZ, kY, lod), share);
}

Look look_of_stone(vec3 at, vec3 n, float lod) {
  const float kNumber = float(PSYGEN_TEXTURE_ROCK);
  vec3 s = n * n * n * n;
  float up = s.y / (s.x + s.y + s.z);
  Look top = look_at(kNumber, at.xz, kX, kZ, lod);
  if (up > 0.99) return top;
  return mixed(look_aside(kNumber, at, vec2(1.0), s.x / (s.x + s.z), lod), top, up);
}

// Repeats twice as often around a trunk as along it.
Look look_of_bark(vec3 at, vec3 n, float lod) {
  vec2 s = n.xz * n.xz + 1e-6;
  return look_aside(float(PSYGEN_TEXTURE_BARK), at, vec2(2.0, 1.0),
                    s.x * s.x / dot(s, s), lod + 0.5);
}

Look look_of_leaves(vec3 at, vec3 n, float lod) {
  const float kNumber = float(PSYGEN_TEXTURE_LEAVES);
  vec3 s = abs(n);
  if (s.y > max(s.x, s.z)) return look_at(kNumber, at.xz, kX, kZ, lod - 0.5);
  return look_aside(kNumber, at, vec2(1.0), s.x > s.z ? 1.0 : 0.0, lod - 0.5);
}

// Changes what is lit of a surface (PSYGEN_SURFACE_…) at `place`, relative to the camera.
void add_detail(int surface, vec3 place, inout vec3 albedo, inout vec3 n, inout float ambient) {
  float away = length(place);
  float near = 1.0 - smoothstep(0.5 * kDetailReach_m, kDetailReach_m, away);
  if (surface == 0 || near <= 0.0) return;
  vec3 at = place_of_textures(place);
  float lod = lod_of_textures(away, dot(place, n) / max(away, 1e-3));
  Look look;
  if (surface == PSYGEN_SURFACE_STONE) {
    look = look_of_stone(at, n, lod);
  } else if (surface == PSYGEN_SURFACE_BARK) {
    look = look_of_bark(at, n, lod);
  } else {
    look = look_of_leaves(at, n, lod);
    if (look.colour.a < PSYGEN_LEAF_GAPS * near) discard;
  }
  albedo *= mix(vec3(1.0), look.colour.rgb, near);
  if (!fine_grain) return;
  n = normalize(n + look.bump * (1.4 * near));
  ambient *= mix(1.0, look.open, near);
}
