// Looking up the textures of the ground (ground_textures.hpp), for ground and for models that are
// made of the same. They stand still in the world. Presets with fine grain have relief.
layout(constant_id = 0) const bool fine_grain = false;
layout(set = 0, binding = PSYGEN_BINDING_GROUND) uniform sampler2DArray textures;

// Of the pattern; all textures repeat a whole number of times in it.
const float kPeriod = float(PSYGEN_GROUND_PERIOD_M);

// The look of a texture at a place.
struct Look {
  vec4 colour;  // factor of the albedo, height
  vec3 bump;    // added to the normal
  float rough, open;
};

// The place in the pattern and the height of `place`, relative to the camera.
vec3 place_of_textures(vec3 place) {
  return place + vec3(frame.ground_anchor.x, frame.horizon_colour.w, frame.ground_anchor.y);
}

// The level of mips by the size of a pixel so far away, the mean of along and across. `facing`:
// cosine between the view and the normal.
float lod_of_textures(float away, float facing) {
  float pixel_m = away * 2.0 * length(frame.ray_down.xyz) / frame.shade.w;
  return log2(max(pixel_m, 1e-4) *
              (float(PSYGEN_GROUND_SIDE) * float(PSYGEN_GROUND_REPEATS) / kPeriod)) -
         0.5 * log2(max(abs(facing), 0.02));
}

// A texture at `p`, whose axes in the world are `u` and `v`.
Look look_at(float number, vec2 p, vec3 u, vec3 v, float lod) {
  vec2 place = p * (float(PSYGEN_GROUND_REPEATS) / kPeriod);
  Look look = Look(textureLod(textures, vec3(place, number), lod), vec3(0.0), 1.0, 1.0);
  look.colour.rgb *= 2.0;
  if (fine_grain) {
    vec4 t = textureLod(textures, vec3(place, float(PSYGEN_GROUND_TEXTURES) + number), lod);
    look.bump = (t.x * 2.0 - 1.0) * u + (t.y * 2.0 - 1.0) * v;
    look.rough = t.z;
    look.open = t.w;
  }
  return look;
}

Look mixed(Look a, Look b, float share) {
  return Look(mix(a.colour, b.colour, share), mix(a.bump, b.bump, share),
              mix(a.rough, b.rough, share), mix(a.open, b.open, share));
}
