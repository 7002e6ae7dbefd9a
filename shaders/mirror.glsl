// The land that water mirrors, taken from the picture of the landscape without water: the mirrored
// ray is followed through its depth. It does not reflect things beyond the edges of that picture, or
// hidden in it; a ray that ends behind a surface mirrors that surface. After McGuire and Mara,
// "Efficient GPU Screen-Space Ray Tracing" (2014).
layout(set = 2, binding = PSYGEN_REFLECTION_COLOUR) uniform sampler2D mirror;
layout(set = 2, binding = PSYGEN_REFLECTION_DEPTH) uniform sampler2D mirror_depth;

const int kMirrorSteps = 32, kMirrorHalvings = 5;

// The light that display values show: the inverse of shown().
vec3 light_of(vec3 display) {
  vec3 y = min(display, 0.98);
  vec3 b = 0.5 - 1.7 * y;
  return 0.004 + (sqrt(b * b + 1.488 * y * (1.0 - y)) - b) / (12.4 * (1.0 - y));
}

float mirror_depth_at(vec2 pixel) { return texelFetch(mirror_depth, ivec2(pixel), 0).r; }

// rgb: light that the surface at `p` gets from the unit direction `r`; a: the share of it that is
// from land, 0 to 1.
vec4 mirrored_land(vec3 p, vec3 r) {
  vec4 from = frame.clip_from_camera * vec4(p, 1.0);
  vec4 along = frame.clip_from_camera * vec4(r, 0.0);
  if (along.w <= 0.0 || frame.water.w > 0.0) return vec4(0.0);
  // On the screen the ray is a line from `start` to its vanishing point. At a share s of the line,
  // its reversed depth is that of `start` times 1 - s.
  vec2 size = frame.shade.zw;
  vec2 start = (from.xy / from.w * 0.5 + 0.5) * size;
  vec2 line = (along.xy / along.w * 0.5 + 0.5) * size - start;
  vec2 to_edge = mix(-start, size - start, greaterThan(line, vec2(0.0))) /
                 mix(line, vec2(1e-4), lessThan(abs(line), vec2(1e-4)));
  float last = min(min(abs(to_edge.x), abs(to_edge.y)), 1.0);
  float depth = from.z / from.w;
  float before = 0.0, hit = -1.0;  // hit: where the ray passes behind the surface that hides it
  for (int i = 0; i < kMirrorSteps; ++i) {
    float s = last * (float(i) + 0.5 + ordered_noise() * 0.5) * (1.0 / float(kMirrorSteps));
    float ray = depth * (1.0 - s);
    float scene = mirror_depth_at(start + s * line);
    if (scene <= ray) {
      hit = -1.0;
    } else {
      if (hit < 0.0) hit = s;
      // The ray meets the surface, unless it passes far behind that.
      float away = 1.0 / ray;
      float behind_by = away - 1.0 / (depth * (1.0 - before)) + 0.1 * away;
      if (away - 1.0 / scene < behind_by) {
        hit = s;
        for (int half_ = 0; half_ < kMirrorHalvings; ++half_) {
          float middle = 0.5 * (before + hit);
          bool behind = mirror_depth_at(start + middle * line) > depth * (1.0 - middle);
          if (behind) hit = middle;
          else before = middle;
        }
        break;
      }
    }
    before = s;
  }
  // A ray that ends hidden mirrors the surface that hides it rather than the sky.
  if (hit < 0.0) return vec4(0.0);
  vec2 at = (start + hit * line) / size;
  float share = smoothstep(0.0, 0.1, min(min(at.x, 1.0 - at.x), at.y));
  vec2 texel = at * size / vec2(textureSize(mirror, 0));
  return vec4(light_of(textureLod(mirror, texel, 0.0).rgb), share);
}
