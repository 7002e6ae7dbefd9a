// Pictures of models seen from around (engine/core/vertex_layout.hpp): alpha-tested, with the square
// root of the albedo. Vertices of such a mesh without a picture use layer 0, which is white.
#ifdef PSYGEN_PICTURE
layout(set = 0, binding = PSYGEN_BINDING_PICTURES) uniform sampler2DArray pictures;
layout(location = 5) in vec2 uv;
layout(location = 6) flat in vec2 layers;  // the first of the picture, and the view

// Between two views spots of one give way to those of the other, over this part of the way.
const float kViewBlend = 0.1;

// Noise of a spot of the picture, -0.5 to 0.5. Spots stay on the picture as it moves and are one to
// two pixels wide.
float noise_of_spot() {
  vec2 across = abs(dFdx(uv)) + abs(dFdy(uv));
  float most = 1.0 / max(max(across.x, across.y), 1e-4);
  float spots = uintBitsToFloat(floatBitsToUint(most) & 0xFF800000u);  // the power of two below
  return ordered_noise(floor(uv * spots), 0.0) - 0.5;
}

// Albedo, and opacity.
vec4 picture() {
  float view = floor(layers.y + 0.5);
  if (abs(abs(layers.y - view) - 0.5) < 0.5 * kViewBlend)
    view = floor(layers.y + 0.5 + kViewBlend * noise_of_spot());
  view -= PSYGEN_PICTURE_VIEWS * floor(view * (1.0 / PSYGEN_PICTURE_VIEWS));
  vec4 texel = texture(pictures, vec3(uv, layers.x + view));
  return vec4(texel.rgb * texel.rgb, texel.a);
}
#endif
