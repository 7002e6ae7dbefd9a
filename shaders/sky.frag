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

// The sky in the direction `d`; below the horizon the depth of water, if there is any: what water
// shows where no ground lies under it.
vec3 clear_light(vec3 d) {
  vec3 sky = sky_light(d);
  if (frame.water.w > 0.0 || frame.water.w < -1e8 || d.y > -1e-6) return sky;
  vec3 p = d * min(frame.water.w / d.y, PSYGEN_WATER_REACH);
  return through_haze(frame.deep_water.rgb, p);
}

void main() {
  vec3 d = ray * inversesqrt(dot(ray, ray));
  float toward = dot(d, frame.sun_direction.xyz);
  float disc = smoothstep(0.99988, 0.99996, toward);
  vec3 light = clear_light(d) + frame.sun_colour.rgb * 12.0 * disc;
  vec2 here = cloud_at(texture(clouds, cloud_place(d)).rg);
  vec3 cloud = frame.cloud_colour.rgb * (cloud_sun(toward) * here.y) + cloud_ambient();
  light = mix(light, cloud, here.x * cloud_presence(max(d.y, 0.0)));
  pixel = vec4(shown(light) + dither(), only_sun ? smoothstep(PSYGEN_SUN_EDGE, 0.9996, toward) : 1.0);
}
