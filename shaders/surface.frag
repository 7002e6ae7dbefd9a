// Writes the colour from the vertex shader. A single varying is fast on software rasterisers. With
// PSYGEN_PICTURE that is light for a white surface, and pictures have the albedo; in views that
// colour draws (PSYGEN_DRAW_COLOUR) they have only the shape.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "fading.glsl"
#ifdef PSYGEN_PICTURE
#include "frame.glsl"
#include "atmosphere.glsl"
#include "pictures.glsl"
layout(location = 7) in vec3 air;
#endif
layout(location = 0) in vec3 colour;
layout(location = 0) out vec4 pixel;

void main() {
#ifdef PSYGEN_PICTURE
  vec4 texel = picture();  // first: derivatives are undefined after a discard
#endif
  leave_out_faded();
#ifdef PSYGEN_PICTURE
  if (texel.a < 0.5) discard;
#ifndef PSYGEN_DRAW_COLOUR
  pixel = vec4(shown(colour * texel.rgb + air), 1.0);
  return;
#endif
#endif
  pixel = vec4(colour, 1.0);
}
