// A landscape of fewer pixels than the picture, scaled up. lavapipe fills a rectangle twenty times as
// fast if it only shows a texture: the first one of its set, of four bytes with blue first, without
// wrapping, its place the first two of four numbers, and nothing else computed.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(set = 0, binding = PSYGEN_SCALE_UP_LANDSCAPE) uniform sampler2D landscape;
layout(location = 0) in vec4 place;
layout(location = 0) out vec4 pixel;

void main() { pixel = texture(landscape, place.xy); }
