// Water whose light is per vertex, blended over what lies under the surface (water.glsl).
#version 460

layout(location = 0) in vec4 colour;
layout(location = 0) out vec4 pixel;

void main() { pixel = colour; }
