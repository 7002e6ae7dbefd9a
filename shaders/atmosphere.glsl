// Sky and haze. With distance, haze approaches the colour that the sky pass draws in the same
// direction, so the horizon blends in. Without clouds and the sun's disc; sky.frag draws those.

// Light of the clear sky from the unit direction `d`.
vec3 sky_light(vec3 d) {
  float low = 1.0 - max(d.y, 0.0);
  float low2 = low * low;
  float low4 = low2 * low2;
  float low8 = low4 * low4;
  vec3 c = mix(frame.zenith_colour.rgb, frame.horizon_colour.rgb, low4);
  c = mix(c, frame.haze_colour.rgb, low8 * low8);
  float toward = max(dot(d, frame.glow_direction.xyz), 0.0);
  float t2 = toward * toward;
  float t4 = t2 * t2;
  float t8 = t4 * t4;
  return c + frame.glow_colour.rgb * (0.03 * t4 + 0.10 * t8 * t8 * t8);
}

// The air between the camera and `p`, relative to it: the light that it adds, and the share of other
// light that it keeps. It extinguishes more blue than red, so far ridges turn blue and far snow
// yellow. Its density falls exponentially with height, so the integral along the ray has a closed
// form.
vec3 haze(vec3 p, out vec3 kept) {
  float distance2 = max(dot(p, p), 1e-6);
  float inverse = inversesqrt(distance2);
  float x = clamp(frame.zenith_colour.w * p.y, -20.0, 20.0);
  float mean = abs(x) < 1e-3 ? 1.0 - 0.5 * x : (1.0 - exp2(-1.442695 * x)) / x;
  kept = exp2(frame.haze_extinction.rgb * (-1.442695 * mean * distance2 * inverse));
  return sky_light(p * inverse) * (1.0 - kept);
}

// `light` from a surface at `p` after the air in between.
vec3 through_haze(vec3 light, vec3 p) {
  vec3 kept;
  vec3 air = haze(p, kept);
  return air + light * kept;
}

// Scene light to display values: a filmic curve that includes the display's gamma. It is a rational
// function, which is cheap per vertex.
vec3 shown(vec3 light) {
  vec3 x = max(light - 0.004, 0.0);
  return (x * (6.2 * x + 0.5)) / (x * (6.2 * x + 1.7) + 0.06);
}

float shown(float light) {
  float x = max(light - 0.004, 0.0);
  return (x * (6.2 * x + 0.5)) / (x * (6.2 * x + 1.7) + 0.06);
}

// Light of sky and ground on a surface with normal `n`.
vec3 ambient_light(vec3 n) {
  vec3 sky = mix(frame.horizon_colour.rgb, frame.zenith_colour.rgb, 0.6);
  return mix(frame.ground_colour.rgb, sky, 0.5 + 0.5 * n.y);
}
