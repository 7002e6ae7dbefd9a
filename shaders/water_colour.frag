// Writes what the vertex shader found for the water: a colour and how much it covers.
#version 460
layout(location = 0) in vec4 colour;
layout(location = 0) out vec4 pixel;

void main() { pixel = colour; }
