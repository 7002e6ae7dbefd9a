// The sky behind everything: clear sky, clouds, the sun.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "atmosphere.glsl"
#include "clouds.glsl"
#include "dither.glsl"

// Draws only the sun and its surroundings, blended over the picture (sun.vert).
layout(constant_id = 0) const bool only_sun = false;
layout(set = 0, binding = PSYGEN_BINDING_CLOUDS) uniform sampler2D clouds;
layout(location = 0) in vec3 ray;
layout(location = 0) out vec4 pixel;

void main() {
  vec3 d = ray * inversesqrt(dot(ray, ray));
  float toward = dot(d, frame.sun_direction.xyz);
  float disc = smoothstep(0.99988, 0.99996, toward);
  vec3 light = sky_light(d) + frame.sun_colour.rgb * 12.0 * disc;
  vec2 here = cloud_at(texture(clouds, cloud_place(d)).rg);
  vec3 cloud = frame.cloud_colour.rgb * (cloud_sun(toward) * here.y) + cloud_ambient();
  light = mix(light, cloud, here.x * cloud_presence(max(d.y, 0.0)));
  pixel = vec4(shown(light) + dither(), only_sun ? smoothstep(PSYGEN_SUN_EDGE, 0.9996, toward) : 1.0);
}
