// Terrain: unpacks core::TerrainVertex, colours by height, slope and a slow pattern, lights and
// hazes. Everything per vertex: the fragment shader only writes the interpolated colour.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "draw.glsl"
#include "atmosphere.glsl"

// x: grid x, grid z, height; y: coarse height, normal; z: sun, ambient, cover
layout(location = 0) in uvec3 packed;
layout(location = 0) out vec3 colour;

float lattice(uvec2 i) {
  uint h = (i.x & 63u) * 0x9E3779B9u ^ (i.y & 63u) * 0x85EBCA6Bu;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  return float(h >> 8) * (1.0 / 16777216.0);
}

// Smooth noise in [0, 1] over the plane, one lattice point per unit, period 64.
float slow_noise(vec2 p) {
  vec2 cell = floor(p);
  vec2 f = p - cell;
  f = f * f * (3.0 - 2.0 * f);
  uvec2 i = uvec2(ivec2(cell));
  float a = mix(lattice(i), lattice(i + uvec2(1, 0)), f.x);
  float b = mix(lattice(i + uvec2(0, 1)), lattice(i + uvec2(1, 1)), f.x);
  return mix(a, b, f.y);
}

vec3 ground_albedo(float height, vec3 n, vec2 plane, float grain) {
  float pattern = 0.5;
  if (frame.ground_colour.w > 0.0)
    pattern = 0.65 * slow_noise(plane * (1.0 / 32.0)) + 0.35 * slow_noise(plane * (1.0 / 8.0));
  float slope = 1.0 - n.y;
  float uneven = (pattern - 0.5) * 2.0;
  vec3 c = mix(frame.grass.rgb, frame.forest.rgb, smoothstep(0.35, 0.62, pattern + slope * 0.5));
  float dry = smoothstep(0.0, 1.0, (height - frame.forest.w) / frame.dry.w + uneven);
  c = mix(c, frame.dry.rgb, dry);
  float sand = smoothstep(0.0, 1.0, (frame.grass.w - height) / frame.sand.w + 0.5 * uneven);
  c = mix(c, frame.sand.rgb, sand);
  float rock = smoothstep(frame.rock.w, frame.snow.w, slope + 0.06 * uneven);
  c = mix(c, frame.rock.rgb, rock);
  float snow = smoothstep(0.0, 1.0, (height - frame.snow_line.x) / frame.snow_line.y + uneven);
  c = mix(c, frame.snow.rgb, snow * (1.0 - smoothstep(0.7 * frame.snow_line.z, frame.snow_line.z, slope)));
  return c * (0.9 + 0.2 * grain);
}

void main() {
  DrawData draw = this_draw();
  vec2 grid = vec2(packed.x & 0x7Fu, (packed.x >> 8) & 0xFFu);
  float skirt = float((packed.x >> 7) & 1u);
  uint fine = packed.x >> 16;
  float height = mix(float(fine), float(packed.y & 0xFFFFu), draw.scale.z) * (1.0 / 65535.0);
  vec3 p = vec3(draw.origin.x + grid.x * draw.origin.w,
                draw.origin.y + height * draw.scale.x,
                draw.origin.z + grid.y * draw.origin.w);
  ivec2 bits = ivec2(int(packed.y << 8) >> 24, int(packed.y) >> 24);
  vec3 n = octahedral_normal(max(vec2(bits) * (1.0 / 127.0), -1.0));

  float grain = float((fine * 0x9E3779B1u) >> 24) * (1.0 / 255.0);
  vec3 albedo = ground_albedo(p.y + frame.horizon_colour.w, n, p.xz + frame.ground_anchor.xy, grain);
  vec2 visible = vec2(packed.z & 0xFFu, (packed.z >> 8) & 0xFFu) * (1.0 / 255.0);  // sun, sky
  float sun = max(dot(n, frame.sun_direction.xyz), 0.0) * visible.x;
  vec3 light = albedo * (ambient_light(n) * visible.y + sun * frame.sun_colour.rgb);

  p.y -= skirt * draw.scale.y;
  colour = shown(through_haze(light, p));
  gl_Position = frame.clip_from_camera * vec4(p, 1.0);
}
