// Shadows of the clouds that the sky shows (clouds.glsl), on everything under them.
layout(set = 0, binding = PSYGEN_BINDING_CLOUDS) uniform sampler2D noises;

// Share of the sun's light that clouds leave at `p`. From there the sun is seen through another place
// of the clouds than from the camera.
float left_by_clouds(vec3 p) {
  vec3 sun = frame.sun_direction.xyz;
  vec2 aside = p.xz - sun.xz * (p.y / max(sun.y, 0.05));
  float density = texture(noises, cloud_place(sun) + aside * frame.clouds.z).r;
  float cover = smoothstep(0.0, 1.0, (density - (1.0 - frame.haze_colour.w)) * (1.0 / 0.22));
  return 1.0 - 0.75 * cover * cloud_presence(max(sun.y, 0.0));
}
