// Near models whose light is per vertex: the colour from the vertex shader, times the brightness of
// bark, stone or leaves, and gaps between leaves. One texture look-up per pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "fading.glsl"

layout(set = 0, binding = PSYGEN_BINDING_GROUND) uniform sampler2DArray detail;
layout(location = 0) in vec3 colour;
layout(location = 1) in vec3 detail_place;   // in periods of the textures
layout(location = 2) in vec3 detail_shares;  // of leaves, of bark, of stone; at most one is not 0
layout(location = 0) out vec4 pixel;

// The texture on the side that the face turns to; bark repeats twice as often around a trunk.
vec2 place_on_face() {
  vec3 n = abs(cross(dFdx(detail_place), dFdy(detail_place)));
  float around = detail_shares.y > 0.0 ? 2.0 : 1.0;
  vec2 aside = n.x > n.z ? detail_place.zy : detail_place.xy;
  return n.y > around * max(n.x, n.z) ? detail_place.xz : vec2(around * aside.x, aside.y);
}

void main() {
  // First: derivatives are undefined after a discard.
  vec4 texel = texture(detail, vec3(place_on_face(), float(PSYGEN_LAYER_OF_MODELS)));
  leave_out_faded();
  if (texel.x < PSYGEN_LEAF_GAPS * detail_shares.x) discard;
  // Display values change half as much as light.
  pixel = vec4(colour * (1.0 + 0.5 * dot(texel.wyz * 2.0 - 1.0, detail_shares)), 1.0);
}
