// The outputs of a mesh's vertex shader, one of four sets:
//   nothing defined         the final colour: one varying, which is fast on software devices
//   PSYGEN_PIXEL_LIGHT      the inputs of surface_lit.frag, or for terrain of ground_lit.frag,
//                           which light each pixel
//   PSYGEN_DRAW_COLOUR      the debug colour of the draw, slightly shaded (views for debugging)
//   PSYGEN_SHADOW           only the position in a cascade
#if defined(PSYGEN_PIXEL_LIGHT)
layout(location = 0) out vec3 place;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 albedo_ambient;
layout(location = 3) out vec3 sun_leaf_surface;
#elif !defined(PSYGEN_SHADOW)
layout(location = 0) out vec3 colour;
#endif
// Also of near terrain whose light is per vertex: the inputs of ground_detail.frag.
#ifdef PSYGEN_GROUND_DETAIL
layout(location = 1) out vec2 detail_place;
layout(location = 2) out vec4 detail_shares;
layout(location = 3) out vec3 shore;
#endif
// The same of near models: the inputs of model_detail.frag.
#ifdef PSYGEN_MODEL_DETAIL
layout(location = 1) out vec3 detail_place;
layout(location = 2) out vec3 detail_shares;
#endif
// Also with PSYGEN_FADING: the share of the draw's pixels (fading.glsl).
#if defined(PSYGEN_FADING) || defined(PSYGEN_OBJECT)
layout(location = 4) flat out float fade;
#endif
// Of models whose surfaces have textures (surface_detail.glsl): the place without wind.
#ifdef PSYGEN_SURFACES
layout(location = 8) out vec3 still_place;
#endif
// Of models with pictures (pictures.glsl): the place in the picture, its first layer and the view;
// and where the colour is final otherwise, the light of the air, which is added to each pixel.
#ifdef PSYGEN_PICTURE
layout(location = 5) out vec2 uv;
layout(location = 6) flat out vec2 layers;
#if !defined(PSYGEN_PIXEL_LIGHT) && !defined(PSYGEN_SHADOW)
layout(location = 7) out vec3 air;
#endif
#endif
// Of objects: the place in textures, and the number of the material.
#ifdef PSYGEN_OBJECT
layout(location = 5) out vec2 uv;
layout(location = 6) flat out uint material_number;
#endif

// The debug colour of a draw (DrawData), shaded by the normal.
vec3 colour_of_draw(float packed_colour, vec3 n) {
  uint bits = uint(packed_colour);
  vec3 c = vec3((bits >> 16) & 0xFFu, (bits >> 8) & 0xFFu, bits & 0xFFu) * (1.0 / 255.0);
  return c * (0.55 + 0.45 * abs(n.y) + 0.15 * n.x);
}
