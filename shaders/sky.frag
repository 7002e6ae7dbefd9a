// The sky behind everything: clear light, clouds on a plane, the sun.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "atmosphere.glsl"

layout(set = 0, binding = PSYGEN_BINDING_CLOUDS) uniform sampler2D clouds;
layout(location = 0) in vec3 ray;
layout(location = 0) out vec4 pixel;

void main() {
  vec3 d = ray * inversesqrt(dot(ray, ray));
  vec3 light = sky_light(d);

  float toward = dot(d, frame.sun_direction.xyz);
  float disc = smoothstep(0.99988, 0.99996, toward);

  // Clouds on a plane above, gone towards the horizon so that the haze of the land meets the sky.
  float up = max(d.y, 0.0);
  vec2 place = d.xz / (up + 0.12);
  float drift = frame.sun_direction.w * 0.002;
  vec2 broad = texture(clouds, place * 0.27 + vec2(drift, 0.3 * drift)).rg;
  float amount = broad.r;
  float edge = 1.0 - frame.haze_colour.w;
  float cover = smoothstep(edge - 0.06, edge + 0.22, amount) * smoothstep(0.015, 0.2, up);
  float thick = smoothstep(edge, edge + 0.45, amount);
  float behind = max(toward, 0.0);
  vec3 bright = frame.cloud_colour.rgb * (0.34 + 0.35 * behind * behind * behind * behind);
  vec3 cloud = bright * (1.0 - 0.5 * thick) * (0.75 + 0.4 * broad.g) +
               mix(frame.horizon_colour.rgb, frame.zenith_colour.rgb, 0.3) * 0.55;
  light += frame.sun_colour.rgb * 12.0 * disc;
  light = mix(light, cloud, 0.88 * cover);

  // Half a step of ordered noise hides the bands of 8 bits.
  float dither = fract(dot(gl_FragCoord.xy, vec2(0.7548777, 0.5698403)));
  pixel = vec4(shown(light) + (dither - 0.5) * (1.0 / 255.0), 1.0);
}
