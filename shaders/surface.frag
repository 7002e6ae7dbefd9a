// Writes the colour from the vertex shader. A single varying is fast on software rasterisers.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "fading.glsl"
layout(location = 0) in vec3 colour;
layout(location = 0) out vec4 pixel;

void main() {
  leave_out_faded();
  pixel = vec4(colour, 1.0);
}
