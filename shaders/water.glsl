// Light from the surface of water, and how it is blended over what was drawn under it. That has the
// colour of deep water where it lies deep (under_water.glsl), and so has the sky below the horizon.

struct WaterLight {
  vec3 all;        // with deep water below
  float mirrored;  // share of light that is reflected
};

// The surface at `p` with normal `n`: the reflection of the sky, or of the land before it
// (mirror.glsl), and light from the depth, mixed by Fresnel's law (Schlick).
WaterLight water_light(vec3 p, vec3 n) {
  vec3 v = p * inversesqrt(max(dot(p, p), 1e-6));
  float facing = clamp(abs(dot(v, n)), 0.0, 1.0);
  float flat_ = 1.0 - facing;
  float flat2 = flat_ * flat_;
  float mirrored = 0.02 + 0.80 * flat2 * flat2 * flat_;
  vec3 r = v - 2.0 * dot(v, n) * n;
#ifdef PSYGEN_MIRROR
  // A far pixel shows many waves, whose slopes cancel in part.
  float rough = 0.35 / (1.0 + dot(p, p) * (1.0 / 3600.0));
  vec3 calm = vec3(rough, 1.0, rough) * n;
  calm *= inversesqrt(dot(calm, calm));
  vec3 to_land = v - 2.0 * dot(v, calm) * calm;
  vec4 land = mirrored_land(p, vec3(to_land.x, abs(to_land.y), to_land.z));
#endif
  r.y = abs(r.y) + 0.03;  // on average, the visible sides of small waves face the camera
  r *= inversesqrt(dot(r, r));
  vec3 sky = sky_light(r);
#ifdef PSYGEN_MIRROR
  sky = mix(sky, land.rgb, land.a);
#endif
  // The sun's reflection in ripples that are not drawn. The share of ripples with the slope that
  // reflects it to the camera is Gaussian (Cox and Munk 1954). This gives a path of glitter, which
  // is longer for a lower sun.
  vec3 h = frame.sun_direction.xyz - v;
  vec2 slope = h.xz / max(h.y, 1e-3) - n.xz / n.y;
  float steep = dot(slope, slope);
  vec3 glint = frame.sun_colour.rgb * (1.3 * exp(-400.0 * steep) + 0.2 * exp(-45.0 * steep));
  return WaterLight(mix(frame.deep_water.rgb, sky, mirrored) + glint * (0.2 + mirrored),
                    mirrored);
}

// The colour to add to a share 1 - a of the picture's. The picture has display values; those of
// light that is added are found exactly for deep water and for a bright bottom, and are linear in
// between; of green, which is most of the brightness. `lit`: additional light from deep water, of lamps.
vec4 water_blend(WaterLight water, vec3 lit, vec3 p) {
  vec3 kept;
  vec3 air = haze(p, kept);
  vec3 deep = frame.deep_water.rgb + lit;
  vec3 all = air + water.all * kept;
  vec3 below = air + deep * kept;
  vec3 from = shown(below), to = shown(all);
  float brighter = kept.g * (0.1 * frame.sun_colour.g + 0.2 * frame.zenith_colour.g);
  float from_bright = shown(below.g + brighter);
  float to_bright = shown(all.g + brighter * (1.0 - water.mirrored));
  float share = clamp((to_bright - to.g) / max(from_bright - from.g, 1e-4), 0.0, 1.0);
  if (frame.water.w > 0.0) share = 0.0;  // from below, nothing is drawn beyond it
  return vec4(max(to - share * from, 0.0), 1.0 - share);
}
