// Lines between points relative to the camera. Their two ends are read from the overlay's buffer.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(set = 2, binding = PSYGEN_LINE_ENDS, std430) readonly buffer Ends {
  OverlayVertex ends[];
};
layout(location = 0) out vec3 colour;

void main() {
  OverlayVertex end = ends[gl_VertexIndex];
  colour = end.colour.rgb;
  gl_Position = frame.clip_from_camera * vec4(end.place.xyz, 1.0);
}
