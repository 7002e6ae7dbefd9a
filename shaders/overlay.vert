// Text quads in pixels. The vertices are read from a buffer, six per quad.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(set = 2, binding = PSYGEN_OVERLAY_VERTICES, std430) readonly buffer Glyphs {
  OverlayVertex vertices[];
};
layout(location = 0) out vec4 colour;
layout(location = 1) out vec2 uv;
layout(location = 2) flat out vec4 look;

void main() {
  OverlayVertex v = vertices[gl_VertexIndex];
  colour = v.colour;
  uv = v.place.zw;
  look = v.look;
  gl_Position = vec4(v.place.xy / frame.ground_anchor.zw * 2.0 - 1.0, 0.0, 1.0);
}
