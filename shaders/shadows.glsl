// The sun's shadow maps.
layout(set = 0, binding = PSYGEN_BINDING_SHADOWS) uniform sampler2DArrayShadow shadow_maps;

// Visible share of the sun in the shadow maps, from nine texels around `p`.
float sun_at(vec3 p, vec3 n) {
  float away = length(p);
  int last = int(frame.shadow.y) - 1;
  int cascade = away < frame.shadow_reach.x ? 0 : away < frame.shadow_reach.y ? 1 : 2;
  if (last < 0) return 1.0;
  float end = frame.shadow_reach[last];
  if (cascade > last || away > end) return 1.0;
  float texel_m = 2.0 * frame.shadow_reach[cascade] * frame.shadow.x;
  vec3 off = (n + frame.sun_direction.xyz) * (1.5 * texel_m);  // prevents self-shadowing
  vec3 q = (frame.shadow_from_camera[cascade] * vec4(p + off, 1.0)).xyz;
  vec2 uv = q.xy * 0.5 + 0.5;
  float lit = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x)
      lit += texture(shadow_maps, vec4(uv + vec2(x, y) * frame.shadow.x, float(cascade), q.z));
  }
  return mix(lit * (1.0 / 9.0), 1.0, smoothstep(0.85 * end, end, away));
}
