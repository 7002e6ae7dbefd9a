// The sky below the horizon, and slightly above it, as a pyramid of few triangles for sky.frag.
// Other surfaces cover nearly all of it, and hidden large triangles cost least.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) out vec3 ray;

void main() {
  float azimuth = float(gl_VertexIndex >> 1) * (6.2831853 / float(PSYGEN_BELOW_SIDES));
  ray = (gl_VertexIndex & 1) == 1 ? vec3(0.0, -1.0, 0.0)
                                  : vec3(cos(azimuth), 0.003, sin(azimuth));
  gl_Position = frame.clip_from_camera * vec4(ray, 0.0);
  gl_Position.z = 0.0;
}
