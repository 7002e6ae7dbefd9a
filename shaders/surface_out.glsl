// What a vertex of a mesh hands on, in one of four ways:
//   nothing defined         its colour, lit and hazed: one varying, which software devices like
//   PSYGEN_PIXEL_LIGHT      what the light needs; surface_lit.frag lights each pixel
//   PSYGEN_DRAW_COLOUR      the colour of its draw, shaded a little (views for understanding)
//   PSYGEN_SHADOW           nothing but its place in a cascade
#if defined(PSYGEN_PIXEL_LIGHT)
layout(location = 0) out vec3 place;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 albedo_ambient;
layout(location = 3) out vec3 sun_leaf_ground;
#elif !defined(PSYGEN_SHADOW)
layout(location = 0) out vec3 colour;
#endif
// With PSYGEN_FADING besides: how much of its draw is there (fading.glsl).
#ifdef PSYGEN_FADING
layout(location = 4) flat out float fade;
#endif

vec3 colour_of_draw(float packed_colour, vec3 n) {
  uint bits = uint(packed_colour);
  vec3 c = vec3((bits >> 16) & 0xFFu, (bits >> 8) & 0xFFu, bits & 0xFFu) * (1.0 / 255.0);
  return c * (0.55 + 0.45 * abs(n.y) + 0.15 * n.x);
}
