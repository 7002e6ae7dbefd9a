// A quad over the whole picture, with places in the image of a landscape of fewer pixels
// (scale_up.frag). The middles of the picture's outermost pixels are those of the landscape's, or a
// hair inside: nothing is seen of what the image has beyond the landscape.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) out vec4 place;  // x, y

void main() {
  vec2 corner = vec2((0x32 >> gl_VertexIndex) & 1, (0x2C >> gl_VertexIndex) & 1);
  vec2 picture = frame.ground_anchor.zw, landscape = frame.shade.zw;
  vec2 texels = max(landscape - 1.02, 0.0) / max(picture - 1.0, 1.0);  // of a pixel
  place = vec4((0.51 + (corner * picture - 0.5) * texels) / picture, 0.0, 0.0);
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
