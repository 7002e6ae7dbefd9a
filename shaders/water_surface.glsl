// The surface of rivers and lakes, blended over ground that is drawn as if it were dry. Needs
// under_water.glsl, lighting.glsl and water.glsl.

// The colour to add to a share 1 - a of the picture's, as water_blend() gives it. `depth`: metres of
// water under the surface; `foam`: share of the surface that foams.
vec4 surface_blend(WaterLight water, vec3 lit, vec3 p, vec3 n, float depth, float foam) {
  vec3 kept;
  vec3 air = haze(p, kept);
  vec3 left = kept_by_water(depth);
  vec3 own = water.all + lit - frame.deep_water.rgb * (1.0 - water.mirrored) * left;
  own = mix(own, ground_light(vec3(0.55), n, 1.0, 1.0), foam);
  float through = (1.0 - water.mirrored) * left.g * (1.0 - foam);
  vec3 from = shown(air), to = shown(air + max(own, 0.0) * kept);
  float bright = kept.g * (0.1 * frame.sun_colour.g + 0.2 * frame.zenith_colour.g);
  float from_bright = shown(air.g + bright);
  float to_bright = shown(air.g + max(own.g, 0.0) * kept.g + through * bright);
  float share = clamp((to_bright - to.g) / max(from_bright - from.g, 1e-4), 0.0, 1.0);
  return vec4(max(to - share * from, 0.0), 1.0 - share);
}
