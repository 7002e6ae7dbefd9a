// Text and areas over the picture: quads in pixels, six vertices each, read from a buffer, with
// coverage from the font atlas, or from the signed distances of letters there.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "stage.glsl"

layout(location = 0) PASSED vec4 colour;
layout(location = 1) PASSED vec2 uv;
layout(location = 2) flat PASSED vec4 look;

#ifdef PSYGEN_VERT
layout(set = 2, binding = PSYGEN_OVERLAY_VERTICES, std430) readonly buffer Glyphs {
  OverlayVertex vertices[];
};

void main() {
  OverlayVertex v = vertices[gl_VertexIndex];
  colour = v.colour;
  uv = v.place.zw;
  look = v.look;
  gl_Position = vec4(v.place.xy / frame.ground_anchor.zw * 2.0 - 1.0, 0.0, 1.0);
}
#else
layout(set = 2, binding = PSYGEN_OVERLAY_FONT) uniform sampler2D font;
layout(location = 0) out vec4 pixel;

// `range_px`: pixels from the least to the greatest distance.
float cover(vec2 at, float range_px) {
  float outside_px = (0.5 - texture(font, at).r) * range_px - look.y;
  return clamp(0.5 - outside_px / look.z, 0.0, 1.0);
}

void main() {
  vec2 step_x = dFdx(uv), step_y = dFdy(uv);
  if (look.x == 0.0) {
    pixel = vec4(colour.rgb, colour.a * texture(font, uv).r);
    return;
  }
  float texels = max(length(step_x * vec2(textureSize(font, 0))), 1e-4);  // of a pixel
  float range_px = look.x / texels;
  // Strokes of small letters are thinner than a pixel: its quarters see more of them.
  vec2 x = 0.25 * step_x, y = 0.25 * step_y;
  float sum = cover(uv - x - y, range_px) + cover(uv + x - y, range_px) +
              cover(uv - x + y, range_px) + cover(uv + x + y, range_px);
  pixel = vec4(colour.rgb, colour.a * 0.25 * sum);
}
#endif
