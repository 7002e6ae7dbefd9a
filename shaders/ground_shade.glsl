// Soft dark spots on the ground near the camera, under what stands there (render::ContactShadowMap).
layout(set = 0, binding = PSYGEN_BINDING_SHADE, std430) readonly buffer GroundShade {
  uint shade_words[];
};

vec2 shade_of_cell(ivec2 cell) {
  ivec2 i = clamp(cell, ivec2(0), ivec2(PSYGEN_SHADE_SIDE - 1));
  uint word = shade_words[uint(i.y * PSYGEN_SHADE_SIDE + i.x) >> 1];
  uint bits = (i.x & 1) != 0 ? word >> 16 : word;
  return vec2(bits & 0xFFu, (bits >> 8) & 0xFFu) * (1.0 / 255.0);
}

// Shares of the sun and of the sky that spots leave at `p`, relative to the camera.
vec2 left_by_spots(vec3 p) {
  vec2 at = p.xz - frame.shade.xy - 0.5;
  ivec2 cell = ivec2(floor(at));
  vec2 f = at - floor(at);
  vec2 missing = mix(mix(shade_of_cell(cell), shade_of_cell(cell + ivec2(1, 0)), f.x),
                     mix(shade_of_cell(cell + ivec2(0, 1)), shade_of_cell(cell + ivec2(1, 1)), f.x),
                     f.y);
  float near = 1.0 - smoothstep(0.6, 1.0, length(p) * (1.0 / float(PSYGEN_NEAR_GROUND_M)));
  return 1.0 - missing * near;
}
