// Text over the picture, with coverage from the font atlas.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(set = 0, binding = PSYGEN_BINDING_FONT) uniform sampler2D font;
layout(location = 0) in vec4 colour;
layout(location = 1) in vec2 uv;
layout(location = 0) out vec4 pixel;

void main() { pixel = vec4(colour.rgb, colour.a * texture(font, uv).r); }
