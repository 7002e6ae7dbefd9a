// Light from a surface of water at `p` with normal `n`: the sky's mirror image and what comes out of
// the depth, by Fresnel's law (Schlick).
vec3 water_light(vec3 p, vec3 n) {
  vec3 v = p * inversesqrt(max(dot(p, p), 1e-6));
  float facing = clamp(abs(dot(v, n)), 0.0, 1.0);
  float flat_ = 1.0 - facing;
  float flat2 = flat_ * flat_;
  float mirrored = 0.02 + 0.80 * flat2 * flat2 * flat_;
  vec3 r = v - 2.0 * dot(v, n) * n;
  r.y = abs(r.y) + 0.03;  // waves that are not drawn lean towards the eye
  r *= inversesqrt(dot(r, r));
  float sun = max(frame.sun_direction.y, 0.0);
  vec3 deep = frame.water.rgb * (ambient_light(vec3(0, 1, 0)) + sun * frame.sun_colour.rgb);
  float toward = max(dot(r, frame.sun_direction.xyz), 0.0);
  float t2 = toward * toward;
  float t8 = t2 * t2 * t2 * t2;
  float t64 = t8 * t8 * t8 * t8 * t8 * t8 * t8 * t8;
  vec3 glint = frame.sun_colour.rgb * (t64 * t64 * t64 * t64 * 1.5 + 0.15 * t64);
  return mix(deep, sky_light(r), mirrored) + glint * (0.2 + mirrored);
}
