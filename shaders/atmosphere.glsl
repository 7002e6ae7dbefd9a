// Sky and haze. The haze of a far surface tends to the very colour that the sky pass paints in that
// direction, so that the horizon melts. No clouds and no sun disc here: those are sky.frag's.

// Light of the clear sky from direction `d` (unit).
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

// `light` from a surface at `p` (relative to the camera), after the air in between, which takes
// more of the blue: far ridges turn blue, and far snow yellow. The density falls exponentially with
// height: the integral along the ray has a closed form.
vec3 through_haze(vec3 light, vec3 p) {
  float distance2 = max(dot(p, p), 1e-6);
  float inverse = inversesqrt(distance2);
  float x = clamp(frame.zenith_colour.w * p.y, -20.0, 20.0);
  float mean = abs(x) < 1e-3 ? 1.0 - 0.5 * x : (1.0 - exp2(-1.442695 * x)) / x;
  vec3 kept = exp2(frame.haze_extinction.rgb * (-1.442695 * mean * distance2 * inverse));
  return mix(sky_light(p * inverse), light, kept);
}

// Scene light to display values: a filmic curve with the display's gamma folded in (rational, so
// that it is cheap per vertex).
vec3 shown(vec3 light) {
  vec3 x = max(light - 0.004, 0.0);
  return (x * (6.2 * x + 0.5)) / (x * (6.2 * x + 1.7) + 0.06);
}

// Light of sky and ground that reaches a surface with normal `n`.
vec3 ambient_light(vec3 n) {
  vec3 sky = mix(frame.horizon_colour.rgb, frame.zenith_colour.rgb, 0.6);
  return mix(frame.ground_colour.rgb, sky, 0.5 + 0.5 * n.y);
}
