// Near ground whose light is per vertex: the colour from the vertex shader, times the brightness of
// what grows or lies there, under the foam of shores. One texture look-up per pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "shore.glsl"

layout(set = 0, binding = PSYGEN_BINDING_GROUND) uniform sampler2DArray detail;
layout(location = 0) in vec3 colour;
layout(location = 1) in vec2 detail_place;
layout(location = 2) in vec4 detail_shares;  // of the texture's four channels
// Metres from the moved edge of the water, noise, and how bright foam is.
layout(location = 3) in vec3 shore;
layout(location = 0) out vec4 pixel;

void main() {
  vec4 brightness = texture(detail, vec3(detail_place, 0.0)) * 2.0 - 1.0;
  // Display values change half as much as light.
  vec3 ground = colour * (1.0 + 0.5 * dot(brightness, detail_shares));
  float foam = 0.8 * film_at(shore.x, shore.y + 0.3 * brightness.x);
  pixel = vec4(mix(ground, vec3(shore.z), foam), 1.0);
}
