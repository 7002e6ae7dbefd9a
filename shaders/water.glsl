// Light from a surface of water at `p` with normal `n`: the reflection of the sky and light from
// the depth, mixed by Fresnel's law (Schlick).
vec3 water_light(vec3 p, vec3 n) {
  vec3 v = p * inversesqrt(max(dot(p, p), 1e-6));
  float facing = clamp(abs(dot(v, n)), 0.0, 1.0);
  float flat_ = 1.0 - facing;
  float flat2 = flat_ * flat_;
  float mirrored = 0.02 + 0.80 * flat2 * flat2 * flat_;
  vec3 r = v - 2.0 * dot(v, n) * n;
  r.y = abs(r.y) + 0.03;  // on average, the visible sides of small waves face the camera
  r *= inversesqrt(dot(r, r));
  float sun = max(frame.sun_direction.y, 0.0);
  vec3 deep = frame.water.rgb * (ambient_light(vec3(0, 1, 0)) + sun * frame.sun_colour.rgb);
  // The sun's reflection in ripples that are not drawn. The share of ripples with the slope that
  // reflects it to the camera is Gaussian (Cox and Munk 1954). This gives a path of glitter, which
  // is longer for a lower sun.
  vec3 h = frame.sun_direction.xyz - v;
  vec2 slope = h.xz / max(h.y, 1e-3) - n.xz / n.y;
  float steep = dot(slope, slope);
  vec3 glint = frame.sun_colour.rgb * (1.3 * exp(-400.0 * steep) + 0.2 * exp(-45.0 * steep));
  return mix(deep, sky_light(r), mirrored) + glint * (0.2 + mirrored);
}
