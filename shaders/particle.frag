// A particle: a disc with a soft edge, or with PSYGEN_TEXTURED the base texture of its material.
// The colour is multiplied by the opacity, so particles that cover nothing add their light.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "materials.glsl"

layout(location = 0) in vec4 colour;
layout(location = 1) in vec2 place;
layout(location = 2) flat in vec2 covers_softness;
layout(location = 0) out vec4 pixel;

void main() {
#ifdef PSYGEN_TEXTURED
  vec4 texel = texture(base_map, vec2(0.5, -0.5) * place + 0.5);
  vec3 shade = colour.rgb * texel.rgb;
  float opacity = colour.a * texel.a;
#else
  vec3 shade = colour.rgb;
  float inside = clamp((1.0 - dot(place, place)) / covers_softness.y, 0.0, 1.0);
  float opacity = colour.a * inside * inside;
#endif
  pixel = vec4(shade * opacity, opacity * covers_softness.x);
}
