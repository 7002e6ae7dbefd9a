// Light of sun and sky on surfaces. Computed per vertex on software devices, else per pixel.

// Light of the ground. `sun` and `ambient` are the visible shares of the sun and of the sky.
vec3 ground_light(vec3 albedo, vec3 n, float sun, float ambient) {
  float facing = max(dot(n, frame.sun_direction.xyz), 0.0) * sun;
  return albedo * (ambient_light(n) * ambient + facing * frame.sun_colour.rgb);
}

// Light of models at `p`. `sun` and `ambient` are the visible shares of the sun and of the sky.
// `leaf` is 0 for solids and 1 for leaves, which are lit from behind too.
vec3 model_light(vec3 albedo, vec3 n, vec3 p, float ambient, float leaf, float sun) {
  float facing = dot(n, frame.sun_direction.xyz);
  float solid = max(facing, 0.0);
  float wrapped = clamp(facing * 0.5 + 0.5, 0.0, 1.0);
  float through = max(-dot(p, frame.sun_direction.xyz) * -inversesqrt(dot(p, p) + 1e-6), 0.0);
  float leafy = wrapped * wrapped * 0.85 + 0.35 * through * through * (1.0 - 0.5 * wrapped);
  float direct = mix(solid, leafy, leaf) * (0.35 + 0.65 * ambient) * sun;
  return albedo * (ambient_light(n) * ambient + direct * frame.sun_colour.rgb);
}
