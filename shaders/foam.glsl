// Foam where water meets the ground. It lies on the ground under and just above the water, so it has
// the shape of each shore and costs nothing elsewhere. Needs shore.glsl, and cloud_shadow.glsl for
// the noise.
// Foam lies up to so many metres under the surface.
const float kFoamDepthM = 0.7;

// Share of the ground at `p` that foam hides. `up`: y of its normal.
float foam_at(vec3 p, float up) {
  float depth = frame.water.w - p.y;
  if (depth > kFoamDepthM || depth < -kWetM) return 0.0;
  float time = frame.sun_direction.w;
  vec2 plane = p.xz + frame.ground_anchor.xy;
  float near = 1.0 / (1.0 + dot(p, p) * (1.0 / 3600.0));  // beyond, the noise is finer than pixels
  float fine = mix(0.5, texture(noises, plane * (1.0 / 8.0) + vec2(0.011, 0.007) * time).g, near);
  float coarse = texture(noises, plane.yx * (1.0 / 64.0)).g;
  // Lines of foam run towards the edge of the water.
  float edge = way_to_shore(depth, up);
  float away = edge - swash_at(coarse);
  float line = fract(0.16 * edge + 0.11 * time + 3.0 * coarse);
  float crest = smoothstep(0.75, 0.95, line) * (1.0 - smoothstep(0.97, 1.0, line));
  crest *= smoothstep(0.46, 0.66, fine) * (1.0 - smoothstep(0.2, kFoamDepthM, depth)) *
           smoothstep(0.0, 0.5, away);
  return clamp(0.8 * film_at(away, fine) + 0.6 * crest, 0.0, 0.8) *
         (1.0 - smoothstep(0.5 * kWetM, kWetM, -depth));
}
