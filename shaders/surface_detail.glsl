// What solid surfaces of models are made of, near the camera: stone from all sides, bark along the
// trunk. Textures are those of the ground (ground_textures.hpp) and stand still in the world. In
// presets with fine grain they have relief.
layout(constant_id = 0) const bool fine_grain = false;
layout(set = 0, binding = PSYGEN_BINDING_GROUND) uniform sampler2DArray textures;

const float kTexturePeriod = 2048.0;  // of the pattern; all textures repeat a whole number of times
const float kDetailReach_m = 120.0;

// Sums of looks from several sides.
struct Detail {
  vec3 colour;  // factor of the albedo
  vec3 bump;    // added to the normal
  float open;   // share of the sky
  float height; // 0 to 1
};

// Adds a texture that is seen along an axis: `u` and `v` are the axes of `p`.
void add_look(inout Detail d, float share, float layer, vec2 p, vec3 u, vec3 v, float lod) {
  if (share < 0.01) return;
  vec2 place = p * (float(PSYGEN_GROUND_REPEATS) / kTexturePeriod);
  vec4 c = textureLod(textures, vec3(place, layer), lod);
  d.colour += share * 2.0 * c.rgb;
  d.height += share * c.a;
  if (!fine_grain) return;
  vec4 t = textureLod(textures, vec3(place, layer + float(PSYGEN_GROUND_TEXTURES)), lod);
  d.bump += share * ((t.x * 2.0 - 1.0) * u + (t.y * 2.0 - 1.0) * v);
  d.open += share * t.w;
}

// Shares of the three axes, which add up to 1.
vec3 sides_of(vec3 n) {
  vec3 s = n * n;
  s *= s;
  return s / (s.x + s.y + s.z);
}

// Changes what is lit of a surface (PSYGEN_SURFACE_…) at `place`, relative to the camera.
void add_detail(float surface, vec3 place, inout vec3 albedo, inout vec3 n, inout float ambient) {
  float away = length(place);
  float near = 1.0 - smoothstep(0.5 * kDetailReach_m, kDetailReach_m, away);
  if (surface < 0.5 || near <= 0.0) return;
  vec3 at = place + vec3(frame.ground_anchor.x, frame.horizon_colour.w, frame.ground_anchor.y);
  float pixel_m = away * 2.0 * length(frame.ray_down.xyz) / frame.shade.w;
  float lod = log2(max(pixel_m, 1e-4) * (float(PSYGEN_GROUND_SIDE) * float(PSYGEN_GROUND_REPEATS) /
                                         kTexturePeriod)) -
              0.5 * log2(max(abs(dot(place, n)) / max(away, 1e-3), 0.1));
  const vec3 x = vec3(1, 0, 0), y = vec3(0, 1, 0), z = vec3(0, 0, 1);
  Detail d = Detail(vec3(0.0), vec3(0.0), 0.0, 0.0);
  float relief = 1.4;
  if (surface < float(PSYGEN_SURFACE_STONE) + 0.5) {
    vec3 s = sides_of(n);
    const float kLayer = float(PSYGEN_TEXTURE_ROCK);
    add_look(d, s.x, kLayer, at.zy, z, y, lod);
    add_look(d, s.y, kLayer, at.xz, x, z, lod);
    add_look(d, s.z, kLayer, at.xy, x, y, lod);
  } else if (surface > float(PSYGEN_SURFACE_BARK) + 0.5) {
    vec3 s = abs(n);
    vec2 p = s.y > max(s.x, s.z) ? at.xz : s.x > s.z ? at.zy : at.xy;
    vec3 u = s.x > max(s.y, s.z) ? z : x, v = s.y > max(s.x, s.z) ? z : y;
    add_look(d, 1.0, float(PSYGEN_TEXTURE_LEAVES), p, u, v, lod - 0.5);
    if (d.height < 0.36 * near) discard;
  } else {
    vec3 s = sides_of(vec3(n.x, 0.0, n.z) + 1e-3);
    const float kLayer = float(PSYGEN_TEXTURE_BARK);
    const vec2 kTwice = vec2(2.0, 1.0);  // as often around as along
    add_look(d, s.x, kLayer, at.zy * kTwice, z, y, lod + 0.5);
    add_look(d, 1.0 - s.x, kLayer, at.xy * kTwice, x, y, lod + 0.5);
    relief = 1.0;
  }
  albedo *= mix(vec3(1.0), d.colour, near);
  if (!fine_grain) return;
  n = normalize(n + d.bump * (relief * near));
  ambient *= mix(1.0, d.open, near);
}
