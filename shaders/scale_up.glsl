// A landscape of fewer pixels than the picture, scaled up: a quad over the whole picture, with places
// in the image of the landscape. The middles of the picture's outermost pixels are those of the
// landscape's, or a hair inside: nothing is seen of what the image has beyond the landscape.
// lavapipe fills a rectangle twenty times as fast if it only shows a texture: the first one of its
// set, of four bytes with blue first, without wrapping, its place the first two of four numbers, and
// nothing else computed.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "stage.glsl"

layout(location = 0) PASSED vec4 place;  // x, y

#ifdef PSYGEN_VERT
void main() {
  vec2 corner = vec2((0x32 >> gl_VertexIndex) & 1, (0x2C >> gl_VertexIndex) & 1);
  vec2 picture = frame.ground_anchor.zw, landscape = frame.shade.zw;
  vec2 texels = max(landscape - 1.02, 0.0) / max(picture - 1.0, 1.0);  // of a pixel
  place = vec4((0.51 + (corner * picture - 0.5) * texels) / picture, 0.0, 0.0);
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}
#else
layout(set = 0, binding = PSYGEN_SCALE_UP_LANDSCAPE) uniform sampler2D landscape;
layout(location = 0) out vec4 pixel;

void main() { pixel = texture(landscape, place.xy); }
#endif
