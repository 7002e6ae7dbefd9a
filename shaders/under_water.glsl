// Ground and models under water, seen from above. Water lets less of their light through, of red the
// most, the deeper they lie; what it scatters itself takes the place of the rest. The surface is
// blended over them (water.glsl). Without water, or with the camera in it, nothing changes. Needs
// atmosphere.glsl.

// Metres of water over what lies at `y`, relative to the camera; 0 above the surface.
float water_over(float y) { return max(frame.water.w - y, 0.0); }

// The share of light from under so many metres of water. It is a parabola that follows an exponential
// at first and ends at a finite depth: it needs no exponential, and deep ground is exactly as dark
// as deep water.
vec3 kept_by_water(float metres) {
  vec3 kept = max(1.0 - frame.water_loss.rgb * metres, 0.0);
  return kept * kept;
}

vec3 through_water(vec3 light, float metres) {
  return mix(frame.deep_water.rgb, light, kept_by_water(metres));
}

// The part of the way to `p` that lies in the air, if the camera does: haze is no denser over deep
// water.
vec3 in_air(vec3 p) {
  float share = p.y < frame.water.w && frame.water.w < 0.0 ? frame.water.w / p.y : 1.0;
  return p * share;
}

// `light` from a surface at `p`, after the water and the air in between.
vec3 through_water_and_haze(vec3 light, vec3 p) {
  return through_haze(through_water(light, water_over(p.y)), in_air(p));
}
