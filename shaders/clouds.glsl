// Clouds on a plane above the camera. They fade out towards the horizon, where the haze of the land
// meets the sky.

// The texture coordinates of the clouds in the unit direction `d`. They stand over the land: the
// camera moves below them (FrameData::clouds).
vec2 cloud_place(vec3 d) { return d.xz * (0.27 / (max(d.y, 0.0) + 0.12)) + frame.clouds.xy; }

// Opacity of clouds at height `up` (the y of a unit direction).
float cloud_presence(float up) { return 0.88 * smoothstep(0.015, 0.2, up); }

// x: share of the sky that a texel covers, 0 to 1. y: share of the sun's light that it reflects.
vec2 cloud_at(vec2 texel) {
  float over = texel.r - (1.0 - frame.haze_colour.w);
  float cover = clamp((over + 0.06) * (1.0 / 0.28), 0.0, 1.0);
  float thick = clamp(over * (1.0 / 0.45), 0.0, 1.0);
  cover = cover * cover * (3.0 - 2.0 * cover);
  thick = thick * thick * (1.5 - thick);  // to one half
  return vec2(cover, (1.0 - thick) * (0.75 + 0.4 * texel.g));
}

// Share of the sun's light that the brightest cloud reflects. `toward` is the cosine between the
// direction and the sun's.
float cloud_sun(float toward) {
  float behind2 = max(toward, 0.0) * max(toward, 0.0);
  return 0.34 + 0.35 * behind2 * behind2;
}
// Light of the sky on clouds.
vec3 cloud_ambient() {
  return mix(frame.horizon_colour.rgb, frame.zenith_colour.rgb, 0.3) * 0.55;
}
