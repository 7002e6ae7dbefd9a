// The sky of sky_dome.vert: one texture look-up and a few operations per pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "clouds.glsl"
#include "dither.glsl"

layout(set = 0, binding = PSYGEN_BINDING_CLOUDS) uniform sampler2D clouds;
layout(location = 0) in vec3 clear;
layout(location = 1) in vec4 cloud;
layout(location = 2) flat in vec3 shade_x;
layout(location = 3) flat in vec3 shade_y;
layout(location = 4) flat in vec3 shade_z;
layout(location = 0) out vec4 pixel;

void main() {
  vec2 here = cloud_at(texture(clouds, cloud.xy).rg);
  float sun = here.y * cloud.w;
  vec3 shade = shade_x + sun * (shade_y + sun * shade_z);
  // This mixes display values; to match mixed light, it takes more of the brighter colour.
  float share = here.x * cloud.z;
  share += 0.8 * share * (1.0 - share);
  pixel = vec4(mix(clear, shade, share) + dither(), 1.0);
}
