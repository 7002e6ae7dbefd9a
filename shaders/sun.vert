// A square around the sun, with the outputs that sky.frag needs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) out vec3 ray;

void main() {
  vec3 sun = frame.sun_direction.xyz;
  vec3 aside = normalize(abs(sun.y) < 0.9 ? vec3(sun.z, 0.0, -sun.x) : vec3(0.0, sun.z, -sun.y));
  vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1) * 2.0 - 1.0;
  ray = sun + (corner.x * aside + corner.y * cross(sun, aside)) * PSYGEN_SUN_REACH;
  gl_Position = frame.clip_from_camera * vec4(ray, 0.0);
  gl_Position.z = 0.0;
}
