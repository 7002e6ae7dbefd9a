// The colour of the ground: kinds of ground by height, slope and a slow pattern, and far forests.
// engine/world/ground_blends.cpp has the same rule without forests; a test runs this text against it.

float lattice(uvec2 i) {
  uint h = (i.x & 63u) * 0x9E3779B9u ^ (i.y & 63u) * 0x85EBCA6Bu;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  return float(h >> 8) * (1.0 / 16777216.0);
}

// Smooth noise in [0, 1] over the plane, with one lattice point per unit and a period of 64.
float slow_noise(vec2 p) {
  vec2 cell = floor(p);
  vec2 f = p - cell;
  f = f * f * (3.0 - 2.0 * f);
  uvec2 i = uvec2(ivec2(cell));
  float a = mix(lattice(i), lattice(i + uvec2(1, 0)), f.x);
  float b = mix(lattice(i + uvec2(0, 1)), lattice(i + uvec2(1, 1)), f.x);
  return mix(a, b, f.y);
}

// Albedo of the ground. `height` is that in the world, `plane` the place in the pattern, `grain`
// random in [0, 1]. `cover`: share of the ground that far forests hide where they can grow.
vec3 ground_albedo(float height, vec3 n, vec2 plane, float grain, float cover) {
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
  float bears = clamp((height - frame.canopy_place.x) * frame.canopy_place.z + 0.5, 0.0, 1.0) *
                clamp((frame.canopy_place.y - height) * frame.canopy_place.z + 0.5, 0.0, 1.0) *
                clamp((frame.canopy.w - slope) * 12.0 + 0.5, 0.0, 1.0);
  c = mix(c, frame.canopy.rgb * (0.55 + 0.9 * grain),
          bears * clamp(cover * (1.0 + 0.8 * uneven), 0.0, 1.0));
  float snow = smoothstep(0.0, 1.0, (height - frame.snow_line.x) / frame.snow_line.y + uneven);
  c = mix(c, frame.snow.rgb, snow * (1.0 - smoothstep(0.7 * frame.snow_line.z, frame.snow_line.z, slope)));
  return c * (0.9 + 0.2 * grain);
}
