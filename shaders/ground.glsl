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

// The slow pattern over the plane, 0 to 1.
float ground_pattern(vec2 plane) {
  float noise = 0.65 * slow_noise(plane * (1.0 / 32.0)) + 0.35 * slow_noise(plane * (1.0 / 8.0));
  return mix(0.5, noise, frame.ground_colour.w > 0.0);
}

// The share that each kind of ground covers of those before it, from grass on, 0 to 1.
struct Blends {
  float forest, dry, sand, rock, canopy, snow;
};

// The blends of a place. `height` is that in the world. `cover`: share of the ground that far
// forests hide where they can grow; below 0 the share of a road, negative.
Blends blends_of(float height, vec3 n, float pattern, float cover) {
  float slope = 1.0 - n.y;
  float uneven = (pattern - 0.5) * 2.0;
  float bears = clamp((height - frame.canopy_place.x) * frame.canopy_place.z + 0.5, 0.0, 1.0) *
                clamp((frame.canopy_place.y - height) * frame.canopy_place.z + 0.5, 0.0, 1.0) *
                clamp((frame.canopy.w - slope) * 12.0 + 0.5, 0.0, 1.0);
  Blends b;
  b.forest = smoothstep(0.35, 0.62, pattern + slope * 0.5);
  b.dry = smoothstep(0.0, 1.0, (height - frame.forest.w) / frame.dry.w + uneven);
  b.sand = smoothstep(0.0, 1.0, (frame.grass.w - height) / frame.sand.w + 0.5 * uneven);
  b.rock = smoothstep(frame.rock.w, frame.snow.w, slope + 0.06 * uneven);
  b.canopy = bears * clamp(cover * (1.0 + 0.8 * uneven), 0.0, 1.0);
  b.snow = smoothstep(0.0, 1.0, (height - frame.snow_line.x) / frame.snow_line.y + uneven) *
           (1.0 - smoothstep(0.7 * frame.snow_line.z, frame.snow_line.z, slope));
  if (cover < 0.0) {
    b.dry = mix(b.dry, 1.0, -cover);
    b.sand = mix(b.sand, 0.0, -cover);
    b.rock = mix(b.rock, 0.6, -cover);
    b.snow = mix(b.snow, 0.3 * b.snow, -cover);
  }
  return b;
}

// Albedo of the ground. `grain` is random in [0, 1].
vec3 blended_albedo(Blends b, float grain) {
  vec3 c = mix(frame.grass.rgb, frame.forest.rgb, b.forest);
  c = mix(c, frame.dry.rgb, b.dry);
  c = mix(c, frame.sand.rgb, b.sand);
  c = mix(c, frame.rock.rgb, b.rock);
  c = mix(c, frame.canopy.rgb * (0.55 + 0.9 * grain), b.canopy);
  c = mix(c, frame.snow.rgb, b.snow);
  return c * (0.9 + 0.2 * grain);
}

// The same at `plane` in the pattern.
vec3 ground_albedo(float height, vec3 n, vec2 plane, float grain, float cover) {
  return blended_albedo(blends_of(height, n, ground_pattern(plane), cover), grain);
}
